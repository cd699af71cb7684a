"""Damages messages: a few for each variant, each in one place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from cobotwire_codegen.model import Edition, Frame
from cobotwire_codegen.targets.vectors.law import Direction, Fault, Law
from cobotwire_codegen.targets.vectors.messages import DIRECTIONS, Example, beyond


class Malformed(NamedTuple):
    """Bytes that are not a message, and the reason."""

    what: str
    direction: Direction
    data: bytes
    fault: Fault


def malformed(
    edition: Edition, laws: dict[Direction, Law], found: Sequence[Example]
) -> Iterator[Malformed]:
    """Yield every kind of damage for every variant, and every number that can be out of range.

    Args:
        edition: the edition.
        laws: its law in each direction.
        found: all its examples.
    """
    for direction, what, data in _broken(edition, found):
        fault = laws[direction].read(data)
        # Damage can produce another legal message; then there is nothing to reject.
        if isinstance(fault, Fault):
            yield Malformed(what, direction, data, fault)


def _broken(edition: Edition, found: Sequence[Example]) -> Iterator[tuple[Direction, str, bytes]]:
    for direction in DIRECTIONS:
        yield direction, "nothing", b""
        first = next((example for example in found if example.direction == direction), None)
        if first is not None and edition.frame.has_command(direction):
            yield direction, "unknown id", _unknown(edition, first)
    for example in found:
        name = f"{example.command.name}"
        if example.what.startswith("ordinary"):
            for what, data in _damaged(edition, example.data):
                yield example.direction, f"{name}, {what}", data
            for case in beyond(edition, example):
                if case.data is not None:
                    what = f"{name}, {case.field.name} {case.raw}"
                    yield example.direction, what, case.data


def _damaged(edition: Edition, data: bytes) -> Iterator[tuple[str, bytes]]:
    frame = edition.frame
    after = frame.offset("length") + frame.length_number.width
    yield "header", bytes([data[0] ^ 1]) + data[1:]
    yield "LEN one less", _with(frame, data, "length", -1)
    yield "LEN one more", _with(frame, data, "length", 1)
    yield "check", data[:-1] + bytes([data[-1] ^ 1])
    yield "last byte missing", data[:-1]
    yield "cut after LEN", data[:after]
    yield "a byte too many", data + b"\x00"
    other = next((byte for byte in range(254, -1, -1) if byte not in frame.address_values), None)
    if frame.address_values and other is not None:
        at = frame.offset("address")
        yield "address", data[:at] + bytes([other]) + data[at + 1 :]


def _with(frame: Frame, data: bytes, part: str, change: int) -> bytes:
    """Return a frame in which LEN or CMD is larger by ``change``."""
    form = frame.length_number if part == "length" else frame.command_number
    at, most = frame.offset(part), 1 << 8 * form.width
    number = int.from_bytes(data[at : at + form.width], form.order) + change
    changed = (number % most).to_bytes(form.width, form.order)
    return data[:at] + changed + data[at + form.width :]


def _unknown(edition: Edition, example: Example) -> bytes:
    """Return a message with an id that its direction of the edition lacks."""
    ids = {command.id for command in edition.commands if command.variants(example.direction)}
    free = next(id for id in range(255, -1, -1) if id not in ids and id not in (0xFE, 0xFA))
    return _with(edition.frame, example.data, "command", free - example.command.id)
