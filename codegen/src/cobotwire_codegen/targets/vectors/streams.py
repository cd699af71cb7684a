"""Builds streams of frames and noise, with the events that a framer must find."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.vectors.law import Direction, Law, Span
from cobotwire_codegen.targets.vectors.messages import DIRECTIONS, Example


class Stream(NamedTuple):
    """The bytes of a stream, and the events in it after a flush at its end."""

    what: str
    direction: Direction
    data: bytes
    spans: tuple[Span, ...]


Recipe = Callable[[Edition, bytes, bytes], bytes]


def streams(
    edition: Edition, laws: dict[Direction, Law], ordinary: Sequence[Example]
) -> Iterator[Stream]:
    """Yield every recipe in every direction until each ordinary example has been in a stream."""
    for direction in DIRECTIONS:
        found = [example for example in ordinary if example.direction == direction]
        for index in range(max(len(found), len(RECIPES)) if found else 0):
            one, other = found[index % len(found)].data, found[(index + 1) % len(found)].data
            what, recipe = RECIPES[index % len(RECIPES)]
            data = recipe(edition, one, other)
            yield Stream(what, direction, data, tuple(laws[direction].cut(data)))


def _false_header(edition: Edition, one: bytes, other: bytes) -> bytes:
    """Return the start of a frame, with a LEN that covers the frames after it."""
    return one[: _body(edition)] + one + other


def _swallowed(edition: Edition, one: bytes, other: bytes) -> bytes:
    """Return a frame that lost a byte, so that its LEN covers the head of the next frame."""
    middle = len(one) // 2
    return one[:middle] + one[middle + 1 :] + other + one


def _servo(edition: Edition, one: bytes, other: bytes) -> bytes:
    """Return a servo packet that ends with the checksum FE, before a header."""
    body = bytes([0x01, 0x04, 0x02, 0x00])
    checked = body + bytes([(0x01 - sum(body)) % 256])
    return b"\xff\xff" + checked + bytes([~sum(checked) & 0xFF]) + one + other


def _nested(edition: Edition, one: bytes, other: bytes) -> bytes:
    """Return a frame inside a frame with a broken end."""
    return one[:-1] + other + bytes([one[-1] ^ 1]) + one


def _body(edition: Edition) -> int:
    """Return the number of bytes before the data."""
    return edition.frame.offset("data")


RECIPES: tuple[tuple[str, Recipe], ...] = (
    ("two frames", lambda edition, one, other: one + other),
    ("a header byte too many", lambda edition, one, other: edition.frame.header[:1] + one + other),
    ("the first byte lost", lambda edition, one, other: one[1:] + other),
    ("a false header", _false_header),
    ("a byte lost within", _swallowed),
    ("a servo packet", _servo),
    ("a wrong check", lambda edition, one, other: one[:-1] + bytes([one[-1] ^ 1]) + other),
    ("a frame in a broken frame", _nested),
    ("text", lambda edition, one, other: b"cmd_len error\r\n" + one + b"\x00\x00" + other),
    ("an unfinished frame at the end", lambda edition, one, other: one + other[:-1]),
    ("headers alone", lambda edition, one, other: edition.frame.header * 5 + one),
    ("a frame cut short, then a frame", lambda edition, one, other: one[:-2] + other + other),
)
