"""Bytes of a pcapng file to blocks: every length is checked before it is believed."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import BinaryIO, NamedTuple

from cobotwire.capture import blocks
from cobotwire.errors import CaptureError

# What Wireshark takes at most, too; a length beyond it is damage.
LARGEST_BLOCK = 16 * 1024 * 1024
SMALLEST_BLOCK = 12
SMALLEST_SECTION = 28


class Block(NamedTuple):
    """One block: where it stands, and how its numbers are spelled (``<`` or ``>``)."""

    offset: int
    kind: int
    body: bytes
    order: str


class Truncated(EOFError):
    """The file ends in the middle of a block that begins at ``offset``."""

    def __init__(self, offset: int) -> None:
        self.offset = offset
        super().__init__(offset)


def blocks_of(file: BinaryIO, name: str) -> Iterator[Block]:
    """The blocks of a file, in order.

    Raises:
        CaptureError: it is no pcapng file, or damaged.
        Truncated: it ends within a block.
    """
    offset, order = 0, ""
    while head := _take(file, 8, offset):
        kind = struct.unpack("<I", head[:4])[0]
        if kind == blocks.SECTION:
            magic = _take(file, 4, offset, within=True)
            order = _order_of(magic, name, offset)
        else:
            magic = b""
            if not order:
                raise CaptureError(name, offset, "no pcapng file: it does not begin with a section")
            kind = struct.unpack(order + "I", head[:4])[0]
        size = struct.unpack(order + "I", head[4:])[0]
        _check_size(size, kind, name, offset)
        rest = magic + _take(file, size - 8 - len(magic), offset, within=True)
        if rest[-4:] != head[4:]:
            raise CaptureError(name, offset, "damaged: a block's two lengths differ")
        yield Block(offset, kind, rest[:-4], order)
        offset += size


def _take(file: BinaryIO, size: int, offset: int, within: bool = False) -> bytes:
    """Exactly ``size`` bytes; nothing at the end of the file, if a block need not follow."""
    data = b""
    while len(data) < size:
        more = file.read(size - len(data))
        if not more:
            if data or within:
                raise Truncated(offset)
            return b""
        data += more
    return data


def _order_of(magic: bytes, name: str, offset: int) -> str:
    for order in "<>":
        if struct.unpack(order + "I", magic)[0] == blocks.BYTE_ORDER_MAGIC:
            return order
    raise CaptureError(name, offset, "no pcapng file: its section has no byte order")


def _check_size(size: int, kind: int, name: str, offset: int) -> None:
    smallest = SMALLEST_SECTION if kind == blocks.SECTION else SMALLEST_BLOCK
    if size % 4 or not smallest <= size <= LARGEST_BLOCK:
        allowed = f"a multiple of 4 in {smallest}..{LARGEST_BLOCK}"
        raise CaptureError(name, offset, f"damaged: a block is {size} bytes long, not {allowed}")


class Fields:
    """Takes a block's body apart from its beginning; what is not there is a CaptureError."""

    def __init__(self, block: Block, name: str) -> None:
        self._block, self._name = block, name
        self._at = 0

    def numbers(self, layout: str) -> tuple[int, ...]:
        """Numbers in the letters of :mod:`struct`."""
        data = self.data(struct.calcsize("=" + layout))
        return struct.unpack(self._block.order + layout, data)

    def data(self, size: int) -> bytes:
        """Bytes, and the padding behind them."""
        end = self._at + size
        if end > len(self._block.body):
            raise CaptureError(self._name, self._block.offset, "damaged: a block's content is cut")
        data = self._block.body[self._at : end]
        self._at = min(end + -size % 4, len(self._block.body))
        return data

    def options(self) -> Iterator[tuple[int, bytes]]:
        """The options that stand behind all else."""
        while self._at < len(self._block.body):
            code, size = self.numbers("HH")
            if code == blocks.END:
                return
            yield code, self.data(size)
