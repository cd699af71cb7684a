"""Compare what the maker's class and ours return for the same reply: type, shape and rounding."""

from __future__ import annotations

from collections.abc import Iterator
from struct import pack
from typing import Any

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.protocol.table import Command, Variant
from cobotwire.pymycobot.migrate.calls import library
from layer_comparison import FAILED, REJECTED, Called, call_ours, call_theirs, class_of
from layer_rulings import REPLIES
from robots.arguments import corners, inside
from robots.comparison import calls_of
from robots.robot import Call, Robot

# Of variants of many sizes, the smallest ones.
MOST_VARIANTS = 3
# Of a method, so many calls are tried until the library accepts one.
MOST_CALLS = 6
# A reply of this size and with this byte looks like an acknowledgement.
ACK_SIZE, ACK_MARK = 8, 0xFF


def _tool_replies(request: bytes) -> list[bytes]:
    """Return what a gripper of a Pro 450 replies: it accepts, refuses, or reports a number."""
    if request[:2] == SENSOR:
        return [bytes([*request[:2], 24, *pack(">6f", *range(6)), 0, 0])]
    at = 3 if request[:2] == HEAD else 0
    return [request[: at + 4] + word.to_bytes(2, "big") + b"\0\0" for word in (1, 0, 300)]


# Messages of other protocols, by the command that passes them on.
SENSOR, HEAD = b"\x01\x04", b"\xfe\xfe"
DATA: dict[str, Any] = {
    "tool_serial_write_data": _tool_replies,
    "base_external_control": lambda request: [b"\x01\x07\x08", b"\x02\x00\x00\x01\x02\x09"],
}


def compare_replies(robot: Robot, stride: int = 1) -> tuple[int, set[str], list[str]]:
    """Return how many results are equal, which methods need a ruling, and the others in words.

    Called are every ``stride``-th method, and those that give their result in a form of its own.
    """
    equal, needed, left = 0, set(), []
    for call, reply in _cases(robot, stride):
        theirs, ours = call_theirs(robot, call, reply), call_ours(robot, call, reply)
        if theirs.result is REJECTED and ours.result is REJECTED:
            continue
        failed = ours.result is FAILED and theirs.result in (None, -1)
        if failed or _same(theirs, ours):
            equal += 1
        elif (robot.peer, call.method) in REPLIES:
            needed.add(call.method)
        else:
            left.append(f"{call.method}, {reply.hex(' ')}: {ours.result}, not {theirs.result}")
    return equal, needed, left


def _same(theirs: Called, ours: Called) -> bool:
    return (theirs.result, _kinds(theirs.result)) == (ours.result, _kinds(ours.result))


def _kinds(result: Any) -> Any:
    """Return the types of a result and of its parts."""
    return [_kinds(each) for each in result] if isinstance(result, list) else type(result)


def _cases(robot: Robot, stride: int) -> Iterator[tuple[Call, bytes]]:
    """Return a call of each method with each reply."""
    codec = codecs.load(robot.table, "reference")
    special = {
        name
        for name, call in library()[class_of(robot).__name__].methods.items()
        if call.result != "plain"
    }
    for at, (method, calls) in enumerate(_by_method(robot).items()):
        if at % stride and method not in special:
            continue
        found = None
        for index, values in _replies(robot.table.command(calls[0].command), calls[0]):
            for call in [found] if found else calls[:MOST_CALLS]:
                reply = _reply(codec, call, index, values)
                if reply is None or call_theirs(robot, call, reply).result is not REJECTED:
                    break
            else:
                continue
            found = call
            if reply is not None:
                yield call, reply


def _by_method(robot: Robot) -> dict[str, list[Call]]:
    """Return the calls of queries that our class offers."""
    offered = set(dir(class_of(robot)))
    found: dict[str, list[Call]] = {}
    queries = {c.name for c in robot.table.commands if c.reply and not c.ack and not c.event}
    for call in calls_of(robot):
        if call.method in offered and call.command in queries and not call.why:
            found.setdefault(call.method, []).append(call)
    return found


def _replies(command: Command, call: Call) -> Iterator[tuple[int, tuple[Any, ...]]]:
    if command.name in DATA and command.reply[0].fields[0].kind == "bytes":
        for data in DATA[command.name](bytes(call.ours[0])):
            sizes = [variant.fields[0].cases[0].numbers for variant in command.reply]
            yield [len(numbers) for numbers in sizes].index(len(data)), (data,)
        return
    for index, variant in enumerate(command.reply[:MOST_VARIANTS]):
        *_, highest = corners(variant)
        for values in (highest, *inside(variant)):
            yield index, values


def _reply(codec: Codec, call: Call, index: int, values: tuple[Any, ...]) -> bytes | None:
    """Return a reply to a call; None if the library takes it for an acknowledgement."""
    command = codec.table.command(call.command)
    variant = command.reply[index]
    reply = codec.encode(
        command.name, "reply", _with_arguments(command, variant, values, call), variant=index
    )
    return None if len(reply) == ACK_SIZE and reply[4] == ACK_MARK else reply


def _with_arguments(
    command: Command, variant: Variant, values: tuple[Any, ...], call: Call
) -> tuple[Any, ...]:
    request = command.request_type(*call.ours)
    pairs = zip(variant.fields, values, strict=True)
    return tuple(getattr(request, f.name) if f.echo else value for f, value in pairs)
