"""Call the maker's class and our class of that name alike, each on a simulated arm of its own.

Both arms are in this process, and time is stepped, so nothing waits.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple

import cobotwire.pymycobot as ours
from cobotwire.editions import load
from cobotwire.protocol.errors import ArmNotReady, ProtocolError
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from layer_rulings import (
    FRAMES,
    LATE,
    MISTAKES,
    MOTIONS,
    OTHER_FRAMES,
    REPLIES,
    RESULTS,
    UNANSWERED,
)
from pymycobot_classes import REJECTIONS
from robots.comparison import calls_of, raised
from robots.driving import ArmPort, driven
from robots.robot import Call, Robot

REJECTED = "rejected"
# The result of a method that returns the arm, so that calls can be chained.
ITSELF = "the arm itself"
# The result of a call that waits for bytes that never come.
ENDLESS = "waits for ever"
# Our call raised an error after it wrote; the library fails by a mistake of its own.
FAILED, MISTAKE = "failed", "fails by mistake"


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


def class_of(robot: Robot) -> Any:
    """Return our class that has the name of the maker's; ``Mercury (A1)`` is the class Mercury."""
    return getattr(ours, robot.peer.partition(" ")[0])


def layer_on(name: str, transport: Any, native: Any = None) -> Any:
    """Return our class of a name on a transport; ``native`` is the client that it uses."""
    kind = getattr(ours, name)
    made = object.__new__(kind)
    made._open(partial(native or kind.NATIVE, transport), False, "raise")
    return made


class Fixed:
    """Stands in for an arm: it replies with the same bytes to everything."""

    wait = None

    def __init__(self, reply: bytes) -> None:
        self._reply = reply

    def connect(self) -> Fixed:
        return self

    def receive(self, data: bytes) -> bytes:
        return self._reply

    def flush(self) -> bytes:
        return b""


def call_theirs(robot: Robot, call: Call, reply: bytes | None = None) -> Called:
    """Call the maker's class on a simulated arm, or one that sends a reply to everything."""
    with driven(robot) as drive:
        arm: Any = drive.arm if reply is None else Fixed(reply)
        port = RecordedPort(arm, drive.clock)
        peer = robot.on(port)
        try:
            result = getattr(peer, call.method)(*call.theirs)
        except TimeoutError:
            return Called(port.written, ENDLESS)
        except (*REJECTIONS, *raised(), AttributeError, LookupError, NotImplementedError):
            return Called(port.written, MISTAKE if port.written else REJECTED)
        return Called(port.written, ITSELF if result is peer else result)


def call_ours(robot: Robot, call: Call, reply: bytes | None = None) -> Called:
    """Call our class of the same name on an arm of the same kind."""
    clock = SteppedClock(1000.0)
    simulated = SimulatedArm(robot.table, clock=clock, powered=True)
    arm: Any = simulated if reply is None else Fixed(reply)
    transport = Recorded(arm, clock)
    layer = layer_on(class_of(robot).__name__, transport, load(robot.edition).CLIENT)
    # What the constructor writes is not a part of the call, and neither is what it reads.
    transport.written, layer._waits = b"", True
    try:
        result = getattr(layer, call.method)(*call.theirs)
    except (ValueError, TypeError, NotImplementedError):
        result = REJECTED
    except (TimeoutError, ProtocolError, ArmNotReady):
        result = FAILED
    return Called(transport.written, ITSELF if result is layer else result)


class Compared(NamedTuple):
    """What the calls of a class showed: how many are equal and ruled, the rest in words.

    ``needed`` are the rulings that a call needs.
    """

    equal: int
    ruled: int
    open: list[str]
    needed: set[str]


def compare(robot: Robot, stride: int = 1, every: int = 1) -> Compared:
    """Compare the calls of a class: of every ``every``-th method each ``stride``-th call."""
    equal, ruled, left, needed = 0, 0, [], set()
    for call in _sample(robot, stride, every):
        theirs, mine = call_theirs(robot, call), call_ours(robot, call)
        if REJECTED in (theirs.result, mine.result):
            # `make robots` compares and rules which values are allowed.
            continue
        if mine.result is FAILED and theirs.result in (None, -1):
            # Both have no reply; the library may have asked again.
            ruled += 1
        elif (mine, type(mine.result)) == (theirs, type(theirs.result)):
            equal += 1
        elif _is_ruled(robot, call, theirs, mine):
            ruled += 1
            needed.add(call.method)
        else:
            left.append(f"{call.method}{call.theirs}: {mine}, not {theirs}")
    return Compared(equal, ruled, left, needed)


def _is_ruled(robot: Robot, call: Call, theirs: Called, mine: Called) -> bool:
    key = robot.peer, call.method
    if mine.result is FAILED and call.method in LATE:
        return True
    if key in UNANSWERED or (key in MISTAKES and theirs.result is MISTAKE):
        return True
    if mine.result == theirs.result and (call.method in FRAMES or key in OTHER_FRAMES):
        return True
    if robot.table.find_role("motion ended") is not None and call.method in MOTIONS:
        return _ended_alike(theirs.result, mine.result)
    return mine.written == theirs.written and (key in RESULTS or key in REPLIES)


def _ended_alike(theirs: Any, mine: Any) -> bool:
    """Return whether both report the same end of a motion; ours raises if the motion failed."""
    return bool(theirs == mine if mine is not FAILED else theirs != 0)


def _sample(robot: Robot, stride: int, every: int) -> Iterator[Call]:
    """Return calls of a robot: of a method at least one for each part that it can address."""
    offered = set(dir(class_of(robot)))
    methods: dict[str, int] = {}
    counts: dict[tuple[str, str | None], int] = {}
    for call in calls_of(robot):
        index = methods.setdefault(call.method, len(methods) + 1)
        place = (call.method, call.address)
        count = counts[place] = counts.get(place, -1) + 1
        chosen = count % stride == 0 and index % every == 0
        if call.method in offered and chosen and not call.why:
            yield call
