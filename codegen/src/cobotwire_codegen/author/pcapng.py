"""Reads the packets of a pcapng file (IETF draft-ietf-opsawg-pcapng): their bytes and directions.

The generator does not need the package cobotwire, so it does not use the reader of that package.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

MAGIC = b"\n\r\r\n"
_ORDERS = {b"\x4d\x3c\x2b\x1a": "<", b"\x1a\x2b\x3c\x4d": ">"}
_INTERFACE, _PACKET = 1, 6  # types of blocks
_FLAGS = 2  # the option with the direction, in the two lowest bits
# The direction for each value of the two bits. The recording program wrote an outbound packet (2),
# which is a request.
_DIRECTIONS = ("both", "reply", "request", "both")


class Packet(NamedTuple):
    """A packet of a port; ``direction`` is ``both`` if the file does not state it."""

    port: int
    direction: str
    data: bytes


def packets(file: bytes) -> Iterator[Packet]:
    """Yield the packets of a file.

    Raises:
        ValueError: it is not a pcapng file, or is damaged.
    """
    at, order, first, ports = 0, "", 0, 0
    while at < len(file) or not order:
        if file.startswith(MAGIC, at):
            # Each section has its own byte order, and counts its ports from 0.
            order, first = _ORDERS.get(file[at + 8 : at + 12], ""), ports
        if not order:
            raise ValueError("the recording is not pcapng")
        block = memoryview(file)[at:]
        kind, size = struct.unpack_from(f"{order}II", block) if len(block) >= 12 else (0, 0)
        if not 12 <= size <= len(block):
            raise ValueError("the recording ends inside a block")
        ports += kind == _INTERFACE
        if kind == _PACKET and size >= 32:
            port, _, _, held = struct.unpack_from(f"{order}IIII", block, 8)
            if held > size - 32:
                raise ValueError("a packet of the recording is longer than its block")
            direction = _direction(block[28 + held + -held % 4 : size - 4], order)
            yield Packet(first + port, direction, bytes(block[28 : 28 + held]))
        at += size


def _direction(options: memoryview, order: str) -> str:
    while len(options) >= 8:
        code, size, value = struct.unpack_from(f"{order}HHI", options)
        if code == _FLAGS:
            return _DIRECTIONS[value & 3]
        options = options[4 + size + -size % 4 :]
    return "both"
