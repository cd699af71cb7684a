"""The calls in which our editions and the maker's classes are compared."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions import load
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Command
from pymycobot_classes import library, written
from pymycobot_ports import RecordingPort
from robots.arguments import arguments_of
from robots.driving import ArmPort, Fixed, stepped
from robots.robot import Call, Robot

# The sizes of a step of the scales that the maker's classes truncate to.
STEPS = (0.1, 0.01, 0.001)


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


def sent_by_peer(robot: Robot, call: Call) -> bytes | None:
    """Return what the maker's class writes; None if it rejects the call."""
    try:
        if robot.table.command(call.command).request_text is not None:
            with stepped() as clock:
                port = ArmPort(Fixed(b""), clock)
                getattr(robot.on(port), call.method)(*call.theirs)
                return port.written
        return written(_recording_peer(robot.peer, robot.opened), call.method, call.theirs)
    except Exception:  # any: the maker's classes fail in many ways
        return None


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
