"""Make the same calls on the maker's class and on ours, each with its own simulated arm.

Both arms are in this process, and time is stepped, so nothing waits.
"""

from __future__ import annotations

import signal
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, NamedTuple

import cobotwire.pymycobot as ours
from cobotwire.editions import load
from cobotwire.protocol.errors import ArmNotReady, ProtocolError, UsageError
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from differences import Difference, relation
from robots.comparison import calls_of, is_truncated
from robots.driving import ArmPort, Fixed, stepped
from robots.robot import Call, Robot

REJECTED = "rejected"
# The result of a method that returns the arm, so that calls can be chained.
ITSELF = "the arm itself"
# The result of a call that waits for bytes that never arrive.
ENDLESS = "waits for ever"
# Our call raised an error after it wrote; the library's call fails by a mistake in the library.
FAILED, MISTAKE = "fails", "fails by mistake"


# The limits of processor time for a call of the maker's class: on a simulated arm, with one reply.
MOST_SECONDS, MOST_FOR_REPLY = 10.0, 0.5


class Recorded(MemoryTransport):
    """A transport to a simulated arm that records what is written."""

    written = b""

    def write(self, data: bytes) -> None:
        self.written += data
        super().write(data)


class Called(NamedTuple):
    """The bytes that a call wrote, and its result; ``rejected`` if it raised an error before it
    wrote."""

    written: bytes
    result: Any
    seconds: float = 0.0


def class_of(robot: Robot) -> Any:
    """Return our class that has the name of the maker's; ``Mercury (A1)`` is the class Mercury."""
    return getattr(ours, robot.peer.partition(" ")[0])


def layer_on(name: str, transport: Any, native: Any = None) -> Any:
    """Return our class of a name on a transport; ``native`` is the client that it uses."""
    kind = getattr(ours, name)
    made = object.__new__(kind)
    made._open(partial(native or kind.NATIVE, transport), False, "raise")
    return made


def call_theirs(robot: Robot, call: Call, reply: bytes | None = None) -> Called:
    """Call the maker's class on a simulated arm, or one that sends a reply to everything."""
    with stepped() as clock:
        port = ArmPort(_arm(robot, clock.time, reply), clock)
        peer, start = robot.on(port), clock.now
        with limited(MOST_SECONDS if reply is None else MOST_FOR_REPLY):
            result = result_of_theirs(peer, call)
        if result is REJECTED and port.written:
            result = MISTAKE
        return Called(port.written, result, clock.now - start)


def result_of_theirs(peer: Any, call: Call) -> Any:
    """Return the result of a method of the maker's class, or how it failed."""
    try:
        result = getattr(peer, call.method)(*call.theirs)
    except TimeoutError:
        return ENDLESS
    except Exception:  # any: the maker's classes fail in many ways
        return REJECTED
    return ITSELF if result is peer else result


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raise TimeoutError in a call that computes for too long: some parsers never end."""

    def stop(*given: object) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGVTALRM, stop)
    # Raise repeatedly: some of the maker's functions catch every exception.
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def call_ours(robot: Robot, call: Call, reply: bytes | None = None) -> Called:
    """Call our class of the same name on an arm of the same kind."""
    with stepped():
        return _call_ours(robot, call, reply)


def _call_ours(robot: Robot, call: Call, reply: bytes | None) -> Called:
    clock = SteppedClock(1000.0)
    transport = Recorded(_arm(robot, clock, reply), clock)
    layer = layer_on(class_of(robot).__name__, transport, load(robot.edition).CLIENT)
    # Bytes that the constructor writes or reads are not part of the call.
    transport.written, layer._waits = b"", True
    start = clock()
    result = result_of_ours(layer, call)
    return Called(transport.written, result, clock() - start)


def result_of_ours(layer: Any, call: Call) -> Any:
    """Return the result of a method of our class, or how it failed."""
    try:
        result = getattr(layer, call.method)(*call.theirs)
    except (UsageError, NotImplementedError):
        result = REJECTED
    except (TimeoutError, ProtocolError, ArmNotReady):
        result = FAILED
    except Exception as error:
        result = REJECTED if is_missing(error) else f"fails by {type(error).__name__}: {error}"
    return ITSELF if result is layer else result


def is_missing(error: Exception) -> bool:
    """Return whether our method rejects a call, because a request needs another argument."""
    return isinstance(error, TypeError) and "missing its argument" in str(error)


def _arm(robot: Robot, clock: Any, reply: bytes | None) -> Any:
    if reply is not None:
        return Fixed(reply)
    return SimulatedArm(robot.table, clock=clock, powered=True)


class Compared(NamedTuple):
    """The result for the calls of a class: how many were compared, and the differences."""

    compared: int
    methods: set[str]
    found: set[Difference]


def compare(robot: Robot, which: int | str = 1) -> Compared:
    """Compare the calls of methods of a class on simulated arms."""
    count, methods, found = 0, set(), set()
    for call in sample(robot, which):
        count += 1
        methods.add(call.method)
        theirs, mine = call_theirs(robot, call), call_ours(robot, call)
        if shows := conversation(robot, theirs, mine):
            found.add(Difference(call.method, "conversation", shows))
    return Compared(count, methods, found)


def conversation(robot: Robot, theirs: Called, mine: Called) -> str:
    """Return how two calls differ: in their frames, then in their results."""
    if REJECTED in (theirs.result, mine.result):
        # `layer_values` compares which values are rejected; neither side writes before it rejects.
        late = [each for each in (theirs, mine) if each.result is REJECTED and each.written]
        return "rejected after it wrote" if late else ""
    if mine.result is FAILED and theirs.result in (None, -1):
        # Neither side got a reply; how often a client repeats a request is not compared.
        return ""
    shows = [_frames(robot, theirs.written, mine.written)]
    if (mine.result, type(mine.result)) != (theirs.result, type(theirs.result)):
        differ = relation(theirs.result, mine.result)
        # Values that the library truncates change what the arm calculates.
        is_truncated_only = theirs.written != mine.written and shows == [""]
        if not (is_truncated_only and differ.endswith("of other values")):
            shows.append(differ)
    return "; ".join(each for each in shows if each)


def _frames(robot: Robot, theirs: bytes, ours: bytes) -> str:
    """Return how the frames differ, apart from numbers that the library truncates."""
    pairs = [_cut(robot, theirs), _cut(robot, ours)]
    ids = [_ids(robot, frames) for frames in pairs]
    if ids[0] != ids[1]:
        return f"sends {ids[1]}, not {ids[0]}"
    different = {
        (a, b) for a, b in zip(*pairs, strict=False) if a != b and not is_truncated(robot, a, b)
    }
    return f"other bytes in {_ids(robot, [b for _, b in different])}" if different else ""


def _cut(robot: Robot, written: bytes) -> list[bytes]:
    """Return the frames in the written bytes; a text after them counts as a frame."""
    frame, found = robot.table.frame, []
    while written.startswith(frame.header) and len(written) > frame.head_size:
        size = frame.read_length(written) + frame.overhead
        found.append(written[:size])
        written = written[size:]
    return [*found, written] if written else found


def _ids(robot: Robot, frames: list[bytes]) -> str:
    """Return the command ids of frames, each once; ``+`` marks one that was repeated."""
    frame = robot.table.frame
    framed = [each.startswith(frame.header) for each in frames]
    ids = [
        f"{frame.read_id(each):02x}" if whole else "text"
        for each, whole in zip(frames, framed, strict=True)
    ]
    return " ".join(each + "+" * (n > 1) for each, n in Counter(ids).items()) or "no frame"


def sample(robot: Robot, which: int | str) -> Iterator[Call]:
    """Return the calls of chosen methods that our class offers."""
    offered = set(dir(class_of(robot)))
    methods: dict[str, list[Call]] = {}
    for call in calls_of(robot):
        if call.method in offered:
            methods.setdefault(call.method, []).append(call)
    for method in chosen(robot, list(methods), which):
        yield from methods[method]


def chosen(robot: Robot, methods: list[str], which: int | str) -> list[str]:
    """Return one method by its name, or every n-th one; the first depends on the class."""
    if isinstance(which, str):
        return [which]
    return methods[len(robot.peer) % which :: which]
