"""Call the maker's class and our class of that name alike, each on a simulated arm of its own.

Both arms are in this process, and time is stepped, so nothing waits.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple

import cobotwire.pymycobot as ours
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from layer_rulings import FRAMES, OTHER_FRAMES, RESULTS, UNANSWERED
from pymycobot_classes import REJECTIONS
from robots.comparison import calls_of, raised
from robots.driving import ArmPort, driven
from robots.robot import Call, Robot

REJECTED = "rejected"
# The result of a method that returns the arm, so that calls can be chained.
ITSELF = "the arm itself"
# The result of a call that waits for bytes that never come.
ENDLESS = "waits for ever"


class Recorded(MemoryTransport):
    """A line to a simulated arm that keeps what is written."""

    written = b""

    def write(self, data: bytes) -> None:
        self.written += data
        super().write(data)


class RecordedPort(ArmPort):
    """The maker's port to a simulated arm; it keeps what is written."""

    written = b""

    def write(self, data: Any) -> int:
        self.written += bytes(data)
        return super().write(data)


class Called(NamedTuple):
    """What a call wrote, and its result; ``rejected`` if it raised an error before it wrote."""

    written: bytes
    result: Any


def layer_on(name: str, transport: Any, errors: str = "raise") -> Any:
    """Return our class of a name on a transport."""
    kind = getattr(ours, name)
    made = object.__new__(kind)
    made._open(partial(kind.NATIVE, transport), False, errors)
    return made


def call_theirs(robot: Robot, call: Call) -> Called:
    """Call the maker's class."""
    with driven(robot) as drive:
        port = RecordedPort(drive.arm, drive.clock)
        peer = robot.on(port)
        try:
            result = getattr(peer, call.method)(*call.theirs)
        except (*REJECTIONS, *raised()):
            return Called(port.written, REJECTED)
        except TimeoutError:
            return Called(port.written, ENDLESS)
        return Called(port.written, ITSELF if result is peer else result)


def call_ours(robot: Robot, call: Call) -> Called:
    """Call our class of the same name."""
    clock = SteppedClock(1000.0)
    arm = SimulatedArm(robot.table, clock=clock, powered=True)
    transport = Recorded(arm, clock)
    layer = layer_on(robot.peer, transport)
    try:
        result = getattr(layer, call.method)(*call.theirs)
    except (ValueError, TypeError, TimeoutError):
        result = REJECTED
    return Called(transport.written, ITSELF if result is layer else result)


class Compared(NamedTuple):
    """What the calls of a class showed: how many are equal and ruled, the rest in words.

    ``needed`` are the rulings that a call needs.
    """

    equal: int
    ruled: int
    open: list[str]
    needed: set[str]


def compare(robot: Robot, stride: int = 1) -> Compared:
    """Compare the calls of a class; of each method every ``stride``-th."""
    equal, ruled, left, needed = 0, 0, [], set()
    for call in _sample(robot, stride):
        theirs, mine = call_theirs(robot, call), call_ours(robot, call)
        if REJECTED in (theirs.result, mine.result):
            # `make robots` compares and rules which values are allowed.
            continue
        if (mine, type(mine.result)) == (theirs, type(theirs.result)):
            equal += 1
        elif (
            (robot.peer, call.method) in UNANSWERED
            or (_may_write_others(robot, call) and mine.result == theirs.result)
            or ((robot.peer, call.method) in RESULTS and mine.written == theirs.written)
        ):
            ruled += 1
            needed.add(call.method)
        else:
            left.append(f"{call.method}{call.theirs}: {mine}, not {theirs}")
    return Compared(equal, ruled, left, needed)


def _may_write_others(robot: Robot, call: Call) -> bool:
    return call.method in FRAMES or (robot.peer, call.method) in OTHER_FRAMES


def _sample(robot: Robot, stride: int) -> Iterator[Call]:
    offered = set(dir(getattr(ours, robot.peer)))
    counts: dict[str, int] = {}
    for call in calls_of(robot):
        count = counts[call.method] = counts.get(call.method, -1) + 1
        if call.method in offered and count % stride == 0 and not call.why:
            yield call
