"""Damages messages: a few for each variant, each in one place."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.vectors.law import Direction, Fault, Law
from cobotwire_codegen.targets.vectors.messages import DIRECTIONS, beyond, examples


class Malformed(NamedTuple):
    """Bytes that are not a message, and the reason."""

    what: str
    direction: Direction
    data: bytes
    fault: Fault


def malformed(edition: Edition, laws: dict[Direction, Law]) -> Iterator[Malformed]:
    """Yield every kind of damage for every variant, and every number that can be out of range."""
    for direction, what, data in _broken(edition):
        fault = laws[direction].read(data)
        # Damage can produce another legal message; then there is nothing to reject.
        if isinstance(fault, Fault):
            yield Malformed(what, direction, data, fault)


def _broken(edition: Edition) -> Iterator[tuple[Direction, str, bytes]]:
    for direction in DIRECTIONS:
        yield direction, "nothing", b""
        for data in _unknown(edition, direction):
            yield direction, "unknown id", data
    for example in examples(edition):
        name = f"{example.command.name}"
        if example.what.startswith("ordinary"):
            for what, data in _damaged(edition, example.data):
                yield example.direction, f"{name}, {what}", data
            for case in beyond(edition, example):
                if case.data is not None:
                    what = f"{name}, {case.field.name} {case.raw}"
                    yield example.direction, what, case.data


def _damaged(edition: Edition, data: bytes) -> Iterator[tuple[str, bytes]]:
    length = len(edition.frame.header) + bool(edition.frame.addresses)
    yield "header", bytes([data[0] ^ 1]) + data[1:]
    yield "LEN one less", _with(data, length, data[length] - 1)
    yield "LEN one more", _with(data, length, data[length] + 1)
    yield "check", _with(data, len(data) - 1, data[-1] ^ 1)
    yield "last byte missing", data[:-1]
    yield "cut after LEN", data[: length + 1]
    yield "a byte too many", data + b"\x00"
    if edition.frame.addresses:
        yield "address", _with(data, length - 1, 0xFE)


def _with(data: bytes, at: int, byte: int) -> bytes:
    return data[:at] + bytes([byte % 256]) + data[at + 1 :]


def _unknown(edition: Edition, direction: Direction) -> Iterator[bytes]:
    """Yield a message with an id that the edition lacks; none if the direction has no messages."""
    ids = {command.id for command in edition.commands if command.variants(direction)}
    free = next(id for id in range(255, -1, -1) if id not in ids and id not in (0xFE, 0xFA))
    at = len(edition.frame.header) + bool(edition.frame.addresses) + 1
    for example in islice((e for e in examples(edition) if e.direction == direction), 1):
        yield _with(example.data, at, free)
