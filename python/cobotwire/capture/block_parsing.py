"""Read the blocks of a pcapng file; every length is checked before it is used."""

from __future__ import annotations

import struct
from collections.abc import Generator, Iterator
from typing import NamedTuple, Protocol

from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.damage import LARGEST_BLOCK, damaged

SMALLEST_BLOCK = 12
SMALLEST_SECTION = 28


class Block(NamedTuple):
    """One block: its offset in the file, and its byte order (``<`` or ``>``)."""

    offset: int
    kind: int
    body: bytes
    order: str


class Truncated(EOFError):
    """The file ends inside the block that begins at ``offset``."""

    def __init__(self, offset: int) -> None:
        self.offset = offset
        super().__init__(offset)


class Closable(Protocol):
    """An object that can be closed."""

    def close(self) -> None:
        """Close the file."""
        ...


class Readable(Closable, Protocol):
    """A file that is read from its beginning to its end."""

    def read(self, size: int, /) -> bytes:
        """Return some bytes, at most ``size``; none at the end."""
        ...


def is_capture(first_bytes: bytes) -> bool:
    """Return whether a file that begins with these bytes (12 suffice) is a pcapng file."""
    magic = struct.pack("<I", blocks.BYTE_ORDER_MAGIC)
    kind = struct.pack("<I", blocks.SECTION)
    return first_bytes[:4] == kind and first_bytes[8:12] in (magic, magic[::-1])


def blocks_of(file: Readable, name: str) -> Iterator[Block]:
    """Yield the blocks of a file, in order.

    Raises:
        CaptureError: the file is not a pcapng file, or it is damaged.
        Truncated: the file ends inside a block.
    """
    cut = cut_blocks(name)
    item = next(cut, None)
    while item is not None:
        if isinstance(item, Block):
            yield item
            item = next(cut, None)
        else:
            try:
                item = cut.send(read_exactly(file, item))
            except StopIteration:
                return


def cut_blocks(name: str) -> Generator[int | Block, bytes, None]:
    """Cut a file into blocks without reading it: yield a number of bytes to send, or a block.

    Send exactly that number of bytes, or fewer if the file ends there.

    Raises:
        CaptureError: the file is not a pcapng file, or it is damaged.
        Truncated: the file ends inside a block.
    """
    offset, order = 0, ""
    while head := (yield 8):
        if len(head) < 8:
            raise Truncated(offset)
        kind = struct.unpack("<I", head[:4])[0]
        magic = b""
        if kind == blocks.SECTION:
            magic = yield 4
            if len(magic) < 4:
                raise Truncated(offset)
            order = order_of(magic, name, offset)
        elif not order:
            raise damaged(name, offset, "not-pcapng")
        kind, size = struct.unpack(order + "II", head)
        check_size(size, kind, name, offset)
        rest = magic + (yield size - 8 - len(magic))
        if len(rest) < size - 8:
            raise Truncated(offset)
        if rest[-4:] != head[4:]:
            raise damaged(name, offset, "lengths-differ")
        yield Block(offset, kind, rest[:-4], order)
        offset += size


def read_exactly(file: Readable, size: int) -> bytes:
    """Return exactly ``size`` bytes, or fewer if the file ends."""
    data = file.read(size)
    while data and len(data) < size:
        more = file.read(size - len(data))
        if not more:
            break
        data += more
    return data


def order_of(magic: bytes, name: str, offset: int) -> str:
    """Return the byte order of a section, from its byte-order magic."""
    for order in "<>":
        if struct.unpack(order + "I", magic)[0] == blocks.BYTE_ORDER_MAGIC:
            return order
    raise damaged(name, offset, "not-pcapng")


def check_size(size: int, kind: int, name: str, offset: int) -> None:
    """Raise CaptureError if a block of a kind cannot have that length."""
    smallest = SMALLEST_SECTION if kind == blocks.SECTION else SMALLEST_BLOCK
    if size % 4 or not smallest <= size <= LARGEST_BLOCK:
        raise damaged(name, offset, "bad-length", size, smallest)


class Fields:
    """Read a block's body from its beginning; reading past its end raises CaptureError."""

    def __init__(self, block: Block, name: str) -> None:
        self._block, self._name = block, name
        self._at = 0

    def numbers(self, format: str) -> tuple[int, ...]:
        """Return numbers in a format of :mod:`struct`."""
        data = self.data(struct.calcsize("=" + format))
        return struct.unpack(self._block.order + format, data)

    def data(self, size: int) -> bytes:
        """Return ``size`` bytes and skip the padding after them."""
        end = self._at + size
        if end > len(self._block.body):
            raise damaged(self._name, self._block.offset, "too-short")
        data = self._block.body[self._at : end]
        self._at = min(end + -size % 4, len(self._block.body))
        return data

    def options(self) -> Iterator[tuple[int, bytes]]:
        """Yield the options at the end of the body."""
        while self._at < len(self._block.body):
            code, size = self.numbers("HH")
            if code == blocks.END:
                return
            yield code, self.data(size)
