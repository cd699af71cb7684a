"""A simulated arm: state for every command, on a pseudo-terminal, over TCP or in memory."""

from typing import TYPE_CHECKING

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
    from cobotwire.protocol.lazy import lazy_names

    __getattr__, __dir__ = lazy_names(
        __name__,
        {
            ".arm": ["SimulatedArm"],
            ".arm_connection": ["ArmConnection"],
            ".clock": ["RunningClock", "SteppedClock"],
            ".memory": ["MemoryTransport"],
            ".pty": ["PtyServer"],
            ".replayed": ["ReplayedArm", "ReplayedRequest"],
            ".server": ["Server"],
            ".tcp": ["TcpServer"],
        },
        (),
    )
