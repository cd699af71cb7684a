"""A whole run of the tester on a peer in memory, in stepped time."""

from __future__ import annotations

from collections.abc import Callable

from cobotwire.conformance import Report, Result, Verdict
from cobotwire.conformance.device import EVERYTHING, Leave, Line, Tester
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from cobotwire.sim.memory import MemoryLink
from cobotwire.sim.peer import Peer
from cobotwire.table import Table

Wrap = Callable[[SimulatedArm], Peer]


def leave(*classes: str, joints: int = 6) -> Leave:
    """Leave for the classes, with a modest workspace where motion is among them."""
    space = {joint: (-60.0, 60.0) for joint in range(1, joints + 1)}
    return Leave.of(classes, joints=joints, max_speed=60, workspace=space)


def prepared(
    table: Table, wrap: Wrap = lambda arm: arm, *, device: Table | None = None, **options: object
) -> Tester:
    """A tester for an edition; the arm speaks that of ``device``, and is wrapped."""
    clock = SteppedClock()
    peer = wrap(SimulatedArm(device or table, clock=clock))
    allowed = options.pop("leave", leave(*EVERYTHING))
    line = Line(MemoryLink(peer, clock), clock)
    return Tester(line, table, leave=allowed, **options)  # type: ignore[arg-type]  # as they come


def bad(report: Report) -> list[Result]:
    """What failed."""
    wrong = (Verdict.FAIL, Verdict.UNSTABLE)
    return [result for result in report.results if result.verdict in wrong]


class Altered:
    """A peer whose answers go through a function: request, answer, number of the request."""

    def __init__(self, peer: Peer, alter: Callable[[bytes, bytes, int], bytes]) -> None:
        self._peer = peer
        self._alter = alter
        self._count = 0

    @property
    def wait(self) -> float | None:
        return self._peer.wait

    def receive(self, data: bytes) -> bytes:
        self._count += 1
        return self._alter(data, self._peer.receive(data), self._count)

    def flush(self) -> bytes:
        return self._peer.flush()


# What a run that was cut short leaves as it is: an arm without power would fall.
HELD = ("powered", "stopped")


def settings_of(arm: SimulatedArm, *, but: tuple[str, ...] = ()) -> str:
    """All that can be set, as one text; ``but`` leaves some of it out."""
    state = arm.state
    every = ("powered", "free", "stopped", "paused", "fresh_mode", "speed", "reference_frame")
    names = [name for name in every if name not in but]
    plain = {name: getattr(state, name) for name in names}
    rows = (state.end_type, state.ssid, state.password, state.tool, state.world, state.registers)
    limits = (state.minimum, state.maximum)
    both = (state.pins, state.basic_pins)
    high = [sorted(pin for pin, high in pins.items() if high) for pins in both]
    return repr((plain, rows, limits, high))
