"""Reads the packets of a pcapng file: their bytes and directions.

The format is IETF draft-ietf-opsawg-pcapng. The generator does not need the package cobotwire, so
it does not use the reader of that package.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

MAGIC = b"\n\r\r\n"
_ORDERS = {b"\x4d\x3c\x2b\x1a": "<", b"\x1a\x2b\x3c\x4d": ">"}
_INTERFACE, _PACKET = 1, 6  # types of blocks
_FLAGS = 2  # the option with the direction
# By the two lowest bits of the flags. What the recording program wrote is a request.
_DIRECTIONS = ("both", "reply", "request", "both")


class Packet(NamedTuple):
    """The bytes of a packet; the direction is ``both`` if the file does not state it.

    ``interface`` differs between the ports of the file.
    """

    interface: int
    direction: str
    data: bytes


def packets(file: bytes) -> Iterator[Packet]:
    """Yield the packets of a file.

    Raises:
        ValueError: it is not a pcapng file, or is damaged.
    """
    at, order, first, seen = 0, "", 0, 0
    while at < len(file) or not order:
        if file.startswith(MAGIC, at):
            # Each section has its own byte order, and counts its interfaces from 0.
            order, first = _ORDERS.get(file[at + 8 : at + 12], ""), seen
        if not order:
            raise ValueError("the recording is not pcapng")
        kind, size = _numbers(file, at, order, 2)
        if size < 12 or at + size > len(file):
            raise ValueError("the recording ends inside a block")
        seen += kind == _INTERFACE
        if kind == _PACKET and size >= 32:
            interface, _, _, held = _numbers(file, at + 8, order, 4)
            if held > size - 32:
                raise ValueError("a packet of the recording is longer than its block")
            start = at + 28
            options = file[start + held + -held % 4 : at + size - 4]
            yield Packet(first + interface, _direction(options, order), file[start : start + held])
        at += size


def _direction(options: bytes, order: str) -> str:
    """Return the direction that the options of a packet state."""
    at = 0
    while at + 8 <= len(options):
        code, size = struct.unpack_from(f"{order}HH", options, at)
        if code == _FLAGS and size == 4:
            return _DIRECTIONS[_numbers(options, at + 4, order, 1)[0] & 3]
        at += 4 + size + -size % 4
    return "both"


def _numbers(data: bytes, at: int, order: str, count: int) -> tuple[int, ...]:
    try:
        return struct.unpack_from(f"{order}{count}I", data, at)
    except struct.error:
        raise ValueError("the recording ends inside a block") from None
