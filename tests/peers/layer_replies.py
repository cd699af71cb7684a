"""Compare what the maker's class and ours return for the same reply: type, shape and value.

The replies are legal replies of the edition, values that the library documents, legal replies with
the request's first argument before them, and data of each size that the library's parser handles.
"""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from functools import cache
from struct import pack
from typing import Any, NamedTuple

from hypothesis import assume
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command, Variant
from differences import Difference, numbers_of, relation
from layer_comparison import (
    ENDLESS,
    FAILED,
    MISTAKE,
    REJECTED,
    Called,
    Compared,
    call_ours,
    call_theirs,
    chosen,
    class_of,
)
from pymycobot_classes import library
from robots.arguments import corners, inside
from robots.classes import ROBOTS
from robots.comparison import calls_of
from robots.robot import Call, Robot
from strategies import legal_values

# The variants of a reply that are compared: at most this many, the smallest first.
MOST_VARIANTS = 3
# The calls of a method that are tried, until the library accepts one.
MOST_CALLS = 3
# Larger data are not drawn: the library reads LEN as a signed byte, and accepts at most 30.
LARGEST = 64
# The fillings of data of any size; sizes that the edition lacks use only the last.
FILLINGS = (0x01, 0x82)
DONE = b"\x01"
SMALLEST = frozenset({0, 1, 2, 3})
# The scales of the words that carry a documented number; single bytes carry it unscaled.
SCALES = (1, 10, 100)
_NUMBER = re.compile(r"-?\b\d+\b")


class Reply(NamedTuple):
    """A reply: its kind in rulings, its data, and the documented number that it carries, if any."""

    kind: str
    data: bytes
    number: int | None = None


def _tool_replies(request: bytes) -> list[bytes]:
    """Return replies of a Pro 450's gripper: it accepts, refuses, or reports a number."""
    if request[:2] == SENSOR:
        return [bytes([*request[:2], 24, *pack(">6f", *range(6)), 0, 0])]
    at = 3 if request[:2] == HEAD else 0
    return [request[: at + 4] + word.to_bytes(2, "big") + b"\0\0" for word in (1, 0, 300)]


# Replies in other protocols, by the command that forwards them.
SENSOR, HEAD = b"\x01\x04", b"\xfe\xfe"
DATA: dict[str, Any] = {
    "tool_serial_write_data": _tool_replies,
    "base_external_control": lambda request: [b"\x01\x07\x08", b"\x02\x00\x00\x01\x02\x09"],
}


def compare_replies(robot: Robot, which: int | str = 1) -> Compared:
    """Compare the results of methods of a class for each of its replies."""
    codec = codecs.load(robot.table, "reference")
    count, methods, found = 0, set(), set()
    by_method = _by_method(robot)
    for method in chosen(robot, list(by_method), which):
        call = _accepted(robot, codec, by_method[method])
        if call is None:
            continue
        methods.add(method)
        for reply in _replies(robot, codec, call):
            count += 1
            if shows := compare_reply(robot, codec, call, reply):
                found.add(Difference(method, reply.kind, shows))
    return Compared(count, methods, found)


def compare_reply(robot: Robot, codec: Codec, call: Call, reply: Reply) -> str:
    """Return how the results of the two sides differ for a reply; empty if they do not."""
    frame = _frame(robot, call, reply.data)
    theirs, ours = call_theirs(robot, call, frame), call_ours(robot, call, frame)
    return _shown(codec, call, reply, frame, theirs, ours)


def _accepted(robot: Robot, codec: Codec, calls: list[Call]) -> Call | None:
    """Return the first call that both sides accept, given a reply of the edition."""
    return next((call for call in calls[:MOST_CALLS] if _is_accepted(robot, codec, call)), None)


@st.composite
def drawn_reply(draw: st.DrawFn, robot: Robot, codec: Codec) -> tuple[Call, Reply]:
    """Draw a call with a reply, and any legal reply to it."""
    call = draw(st.sampled_from(list(_by_method(robot).values())).flatmap(st.sampled_from))
    assume(call.command not in DATA and _is_accepted(robot, codec, call))
    command = _command(codec, call)
    index = draw(st.integers(0, len(command.reply) - 1))
    variant = command.reply[index]
    values = _with_arguments(command, variant, draw(legal_values(variant)), call)
    frame = codec.encode(call.command, "reply", values, variant=index)
    return call, Reply(EDITION, codec.table.frame.data(frame, "reply"))


def _shown(
    codec: Codec, call: Call, reply: Reply, frame: bytes, theirs: Called, ours: Called
) -> str:
    both_fail = ours.result is FAILED and theirs.result in (None, -1, MISTAKE, ENDLESS)
    if both_fail or _same(theirs.result, ours.result):
        return ""
    # No source says what an acknowledgement other than 1 means; ours returns 1.
    acknowledges = _command(codec, call).ack and reply.data != DONE
    if acknowledges and (numbers_of(ours.result) == [1] or ours.result is FAILED):
        return ""
    if reply.kind == ANY and ours.result is FAILED and not _is_legal(codec, call, frame):
        # Ours rejects a reply that no source describes; the library returns whatever it parses.
        return ""
    if reply.kind == DOCUMENTED and set(numbers_of(theirs.result)) != {reply.number}:
        # The library does not return the documented number.
        return ""
    shows = relation(theirs.result, ours.result)
    # For data of any size, ignore how many numbers each side returns.
    return re.sub(r"\d+ ", "", shows) if reply.kind == ANY else shows


def _same(theirs: Any, ours: Any) -> bool:
    if theirs != ours or type(theirs) is not type(ours):
        return False
    return not isinstance(theirs, list) or all(map(_same, theirs, ours))


def _is_legal(codec: Codec, call: Call, frame: bytes) -> bool:
    """Return whether a frame is a legal reply of the edition."""
    try:
        codec.decode("reply", frame, of=call.command)
    except ProtocolError:
        return False
    return True


def _command(codec: Codec, call: Call) -> Command:
    return codec.table.command(call.command)


def _frame(robot: Robot, call: Call, data: bytes) -> bytes:
    device = robot.device(call.address)
    address = device.value if device else None
    return robot.table.frame.enclose(robot.table.command(call.command).id, data, address, "reply")


def _is_accepted(robot: Robot, codec: Codec, call: Call) -> bool:
    """Return whether both sides accept a call, given a reply of the edition."""
    reply = next(_legal(codec, call), None)
    if reply is None:
        return False
    frame = _frame(robot, call, reply)
    results = [each(robot, call, frame).result for each in (call_theirs, call_ours)]
    return REJECTED not in results


def _by_method(robot: Robot) -> dict[str, list[Call]]:
    """Return the calls that our class offers and that have a reply."""
    offered = set(dir(class_of(robot)))
    found: dict[str, list[Call]] = {}
    # A robot that reports the end of a motion sends the reply then, perhaps minutes later.
    waits = robot.table.find_role("motion ended") is not None
    replied = {
        c.name for c in robot.table.commands if c.reply and not (c.event or (c.ack and waits))
    }
    for call in calls_of(robot):
        # The methods that wait for the end of a motion also send other requests.
        if call.method in offered and call.command in replied and "sync_" not in call.method:
            found.setdefault(call.method, []).append(call)
    return found


EDITION, DOCUMENTED, NAMED, ANY = "of the edition", "documented", "with its number", "any"


def _replies(robot: Robot, codec: Codec, call: Call) -> Iterator[Reply]:
    """Yield replies with distinct data, each under the first kind that has these data."""
    seen: set[bytes] = set()
    for reply in _all_replies(robot, codec, call):
        if reply.data not in seen and len(reply.data) <= LARGEST:
            seen.add(reply.data)
            yield reply


def _all_replies(robot: Robot, codec: Codec, call: Call) -> Iterator[Reply]:
    legal, command = list(_legal(codec, call)), _command(codec, call)
    kind: Any = library(robot.peer)
    yield from (Reply(EDITION, data) for data in legal)
    sizes = {variant.size for variant in command.reply if variant.size <= LARGEST}
    for number in () if command.ack else _documented(kind, call.method):
        for size in sizes:
            yield Reply(DOCUMENTED, bytes([number & 0xFF] * size), number)
            for scale in SCALES:
                word = (number * scale & 0xFFFF).to_bytes(2, "big")
                yield Reply(DOCUMENTED, (word * size)[:size], number)
    if not command.ack and call.theirs and isinstance(call.theirs[0], int):
        first = bytes([call.theirs[0] & 0xFF])
        for data in legal:
            read = [call_theirs(robot, call, _frame(robot, call, d)) for d in (data, first + data)]
            if _same(read[0].result, read[1].result):
                yield Reply(NAMED, first + data)
    near = {size + step for size in sizes for step in (-1, 0, 1)} - {-1}
    # What our class does with data of any size depends on the robot only.
    further = _distinguished() if not command.ack and robot.peer in ROBOTS else SMALLEST
    if command.name in DATA:
        # The command forwards data of any size.
        return
    for size in sorted(near | further):
        fillings = FILLINGS if size in sizes else FILLINGS[-1:]
        yield from (Reply(ANY, bytes([filling] * size)) for filling in fillings)


@cache
def _documented(kind: Any, method: str) -> tuple[int, ...]:
    """Return the numbers in the part of a library docstring that describes the result."""
    text = inspect.getdoc(getattr(kind, method)) or ""
    after = re.split(r"(?i)returns?:", text)[1:]
    return tuple(sorted({int(each) for part in after for each in _NUMBER.findall(part)}))


@cache
def _distinguished() -> frozenset[int]:
    """Return the sizes of data that the library's parsers compare with, and the smallest ones."""
    from pymycobot import close_loop, common, mybuddy, pro630common

    found = {*SMALLEST}
    for module in (common, close_loop, mybuddy, pro630common):
        for node in ast.walk(ast.parse(inspect.getsource(module))):
            if isinstance(node, ast.Compare) and "len" in ast.unparse(node.left):
                parts = [n for part in node.comparators for n in ast.walk(part)]
                constants = [n.value for n in parts if isinstance(n, ast.Constant)]
                found |= {n for n in constants if isinstance(n, int) and 0 <= n <= LARGEST}
    return frozenset(found)


def _legal(codec: Codec, call: Call) -> Iterator[bytes]:
    """Return data of replies of the edition."""
    command, frame = _command(codec, call), codec.table.frame
    if command.name in DATA and command.reply[0].fields[0].kind == "bytes":
        yield from DATA[command.name](bytes(call.ours[0]))
        return
    for index, variant in enumerate(command.reply[:MOST_VARIANTS]):
        for values in (*corners(variant), *inside(variant)):
            given = _with_arguments(command, variant, values, call)
            reply = codec.encode(command.name, "reply", given, variant=index)
            yield frame.data(reply, "reply")


def _with_arguments(
    command: Command, variant: Variant, values: tuple[Any, ...], call: Call
) -> tuple[Any, ...]:
    if not any(field.echo for field in variant.fields):
        return values
    request = command.request_type(*call.ours)
    pairs = zip(variant.fields, values, strict=True)
    return tuple(getattr(request, f.name) if f.echo else value for f, value in pairs)
