"""A simulated arm: state for every command, on a pseudo-terminal, over TCP or in memory."""

from typing import TYPE_CHECKING, Any

__all__ = [
    "ArmConnection",
    "MemoryTransport",
    "PtyServer",
    "ReplayedArm",
    "ReplayedRequest",
    "RunningClock",
    "Server",
    "SimulatedArm",
    "SteppedClock",
    "TcpServer",
]

if TYPE_CHECKING:
    from cobotwire.simulator.arm import SimulatedArm
    from cobotwire.simulator.arm_connection import ArmConnection
    from cobotwire.simulator.clock import RunningClock, SteppedClock
    from cobotwire.simulator.memory import MemoryTransport
    from cobotwire.simulator.pty import PtyServer
    from cobotwire.simulator.replayed import ReplayedArm, ReplayedRequest
    from cobotwire.simulator.server import Server
    from cobotwire.simulator.tcp import TcpServer
else:
    # Each name is imported on first use: every pytest run imports the plugin in ``testing``, and
    # must not import the arm and the servers with it.
    _MODULES = {
        "ArmConnection": "arm_connection",
        "MemoryTransport": "memory",
        "PtyServer": "pty",
        "ReplayedArm": "replayed",
        "ReplayedRequest": "replayed",
        "RunningClock": "clock",
        "Server": "server",
        "SimulatedArm": "arm",
        "SteppedClock": "clock",
        "TcpServer": "tcp",
    }

    def __getattr__(name: str) -> Any:
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib import import_module

        found = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
        globals()[name] = found
        return found

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})
