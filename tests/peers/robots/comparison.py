"""Compare the bytes that the maker's class and our client write for the same call."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Iterator
from functools import lru_cache, partial
from inspect import Parameter
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions import load
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Command
from differences import rulings
from pymycobot_classes import library, recording_client, written
from pymycobot_ports import RecordingPort
from robots.arguments import Named, arguments_of
from robots.driving import ArmPort, Fixed, stepped
from robots.robot import Call, Robot

REJECTED, OPEN = "rejected: ", "open: "
# `make layer` compares the class for it with the edition of newer firmware.
OLDEST = "mycobot"
# The sizes of a step of the scales that the maker's classes truncate to.
STEPS = (0.1, 0.01, 0.001)


class Compared(NamedTuple):
    """A method, and what its calls showed.

    Attributes:
        method: the name of the maker's method.
        equal: how many calls write the same bytes.
        ruled: how many differ with a reason.
        reasons: these reasons, each once.
        open: the others, in words.
    """

    method: str
    equal: int
    ruled: int
    reasons: tuple[str, ...]
    open: tuple[str, ...]


def compare(robot: Robot, methods: Iterable[str] | None = None) -> list[Compared]:
    """Return the results of methods of a class; by default of all public methods that send a frame.

    A ruling that no call needs counts as open, so that the rulings stay true.
    """
    by_method: dict[str, list[Call]] = {}
    for call in calls_of(robot):
        by_method.setdefault(call.method, []).append(call)
    wanted = robot.public if methods is None else methods
    return [_compared(robot, method, by_method.get(method, [])) for method in wanted]


def calls_of(robot: Robot) -> Iterator[Call]:
    """Return the calls that are compared: those of the table, then the robot's own."""
    have = set()
    for edition in (robot.edition, *robot.further):
        for command in load(edition).TABLE.commands:
            method = robot.method(command)
            if command.event or method in have or not hasattr(library(robot.peer), method):
                continue
            if method not in robot.not_ours:
                yield from _calls_of(robot, command, method)
        have |= {robot.method(command) for command in load(edition).TABLE.commands}
    yield from robot.calls


def _calls_of(robot: Robot, command: Command, method: str) -> Iterator[Call]:
    given = robot.own_arguments.get(command.name) or list(arguments_of(command))
    for address in robot.addresses(command):
        before = () if command.name in robot.without_address else robot.before[address]
        for arguments in given:
            yield Call(method, (*before, *arguments), command.name, arguments, address)


def _compared(robot: Robot, method: str, calls: list[Call]) -> Compared:
    if method in robot.not_ours:
        return Compared(method, 0, 1, (robot.not_ours[method],), ())
    if not calls:
        return Compared(method, 0, 0, (), ("no command of ours is compared with it",))
    equal, reasons, left = 0, [], []
    unused = list(robot.rulings.get(method, ()))
    for call in calls:
        why = difference(robot, call)
        unused = [ruling for ruling in unused if ruling.why != why]
        if call.why and why is None:
            left.append(f"{call.theirs}: equal, but a difference is listed: {call.why}")
        elif why is None:
            equal += 1
        elif why.startswith(OPEN):
            left.append(why.removeprefix(OPEN))
        else:
            reasons.append(why)
    left += [f"no call needs the ruling: {ruling.why}" for ruling in unused]
    return Compared(method, equal, len(reasons), tuple(dict.fromkeys(reasons)), tuple(left))


def difference(robot: Robot, call: Call) -> str | None:
    """Return the ruling on the difference of a call, or ``open:`` and the difference; None: there
    is none."""
    theirs, ours = sent_by_peer(robot, call), sent_by_us(robot, call)
    if theirs == ours and isinstance(theirs, bytes):
        return None
    shows = f"{OPEN}{call.theirs}: {shown(theirs)}; ours: {shown(ours)}"
    return _reason(robot, call, theirs, ours) or shows


def _reason(robot: Robot, call: Call, theirs: bytes | str, ours: bytes | str) -> str:
    if call.why:
        return call.why
    for ruling in robot.rulings.get(call.method, ()):
        if ruling.shows in shown(theirs):
            return ruling.why
    if isinstance(theirs, bytes) and isinstance(ours, bytes) and is_truncated(robot, theirs, ours):
        return "the nearest step; the maker truncates"
    if robot.edition == OLDEST or isinstance(ours, str):
        return ""
    # `make layer` compares the class of the same name with its edition; these are its results.
    side = "only ours" if isinstance(theirs, str) else "other bytes"
    for each in rulings():
        named = robot.peer in each.names and call.method in each.methods
        if named and each.shows.startswith(side):
            return each.why
    return ""


def shown(sent: bytes | str) -> str:
    """Return bytes as hex digits, or why nothing was sent."""
    return sent if isinstance(sent, str) else sent.hex(" ")


def sent_by_peer(robot: Robot, call: Call) -> bytes | str:
    """Return what the maker's class writes, or why it rejects the call."""
    try:
        if _has_text(robot, call.command):
            with stepped() as clock:
                port = ArmPort(Fixed(b""), clock)
                getattr(robot.on(port), call.method)(*call.theirs)
                return port.written
        return written(_recording_peer(robot.peer, robot.opened), call.method, call.theirs)
    except Exception as error:  # any: the maker's classes fail in many ways
        return f"{REJECTED}{type(error).__name__}: {error}"


def sent_by_us(robot: Robot, call: Call) -> bytes | str:
    """Return what our client writes, or why it rejects the call."""
    edition = load(_edition_of(robot, call.command))
    try:
        client = recording_client("reference", edition.CLIENT)
        if call.address is not None:
            client = client.at(call.address)
        given = partial(getattr(client, call.command), **_by_name(client, call))
        return written(given, "__call__", call.ours[: len(call.ours) - len(given.keywords)])
    except (UsageError, TypeError) as error:
        return f"{REJECTED}{error}"


def _by_name(client: Any, call: Call) -> dict[str, Any]:
    """Return the last arguments of a call, which our method takes by their names only."""
    if not isinstance(call.ours, Named):
        return {}
    taken = inspect.signature(getattr(client, call.command)).parameters
    pairs = zip(call.ours.names, call.ours, strict=True)
    return {name: value for name, value in pairs if taken[name].kind is Parameter.KEYWORD_ONLY}


def _edition_of(robot: Robot, command: str) -> str:
    for edition in (robot.edition, *robot.further):
        if any(each.name == command for each in load(edition).TABLE.commands):
            return edition
    raise AssertionError(f"{robot.peer}: no edition has {command}")


def _has_text(robot: Robot, command: str) -> bool:
    table = load(_edition_of(robot, command)).TABLE
    return table.command(command).request_text is not None


@lru_cache
def _recording_peer(peer: str, opened: Any) -> Any:
    return opened(peer, RecordingPort())


def is_truncated(robot: Robot, theirs: bytes, ours: bytes) -> bool:
    """Return whether frames differ only in numbers that the maker cut off by one step."""
    for edition in (robot.edition, *robot.further):
        read = [_numbers(_codec(edition), each) for each in (theirs, ours)]
        if read[0] is not None and read[1] is not None and len(read[0]) == len(read[1]):
            different = [(a, b) for a, b in zip(*read, strict=True) if a != b]
            return bool(different) and all(
                any(abs(abs(b) - abs(a) - step) < step / 100 for step in STEPS)
                for a, b in different
            )
    return False


@lru_cache
def _codec(edition: str) -> Codec:
    return codecs.load(load(edition).TABLE, "reference")


def _numbers(codec: Codec, frame: bytes) -> list[float] | None:
    try:
        values = codec.decode("request", frame).values
    except ProtocolError:
        return None
    rows = (value if isinstance(value, tuple) else (value,) for value in values)
    return [each for row in rows for each in row if isinstance(each, int | float)]
