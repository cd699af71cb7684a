"""Read the blocks of a pcapng file as they are stored, to write them again unchanged."""

from __future__ import annotations

import os
import re
import struct
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing, contextmanager
from typing import NamedTuple

from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.block_parsing import (
    SMALLEST_BLOCK,
    Block,
    Readable,
    check_size,
    order_of,
)
from cobotwire.capture.capture_file import open_capture
from cobotwire.capture.damage import LARGEST_BLOCK, damaged
from cobotwire.protocol.errors import CaptureError, LinkError

Progress = Callable[[int], None]
# Takes a range of bytes, and why it is lost.
Lose = Callable[[int, int, str], None]

# Bytes to read at a time.
_READ = 1 << 20
# The blocks that a search after damage finds: packets and the like, secrets, private blocks.
_KINDS = (*range(1, 7), 10, 0x0BAD, 0x40000BAD, blocks.SECTION)
_SECTION = struct.pack("<I", blocks.SECTION)
_ORDERS = {struct.pack(order + "I", blocks.BYTE_ORDER_MAGIC): order for order in "<>"}


class StoredBlock(NamedTuple):
    """A block with its offset in the file, its byte order (``<`` or ``>``) and all its bytes."""

    offset: int
    kind: int
    order: str
    data: bytes

    @property
    def parsed(self) -> Block:
        """The block for a parser."""
        return Block(self.offset, self.kind, self.data[8:-4], self.order)


class BlockFile:
    """Iterates over the blocks of a file. Memory is bounded whatever the file contains.

    Attributes:
        name: the name of the file, for messages.
        incomplete: what is missing at the end of the file; empty if nothing is missing.
    """

    def __init__(self, file: Readable, name: str, progress: Progress, lose: Lose | None) -> None:
        self.name, self.incomplete = name, ""
        self._file, self._progress, self._lose = file, progress, lose
        self._order, self._ended = "", False
        # Bytes that were read but not passed on yet; they begin at the offset ``_start`` of the
        # file.
        self._data = b""
        self._start = self._at = 0

    def __iter__(self) -> Iterator[StoredBlock]:
        """Yield the blocks that are left.

        Raises:
            CaptureError: the file does not begin with a block of a pcapng file; or it is damaged,
                and ``lose`` is None.
        """
        while True:
            try:
                yield from self._whole_blocks()
                why = self.incomplete
            except CaptureError as error:
                if self._lose is None or self._start + self._at == 0:
                    raise
                why = error.detail
            if not why or self._lose is None:
                return
            begin = self._start + self._at
            self._skip_damage()
            self._lose(begin, self._start + self._at, why)
            self.incomplete = ""

    def _whole_blocks(self) -> Iterator[StoredBlock]:
        sizes = struct.Struct((self._order or "<") + "II").unpack_from
        while True:
            if len(self._data) - self._at < SMALLEST_BLOCK and not self._reaches(SMALLEST_BLOCK):
                return self._end()
            at, data = self._at, self._data
            kind, size = sizes(data, at)
            if kind == blocks.SECTION:
                self._order = order_of(data[at + 8 : at + 12], self.name, self._start + at)
                sizes = struct.Struct(self._order + "II").unpack_from
                kind, size = sizes(data, at)
            elif not self._order:
                raise damaged(self.name, self._start + at, "not-pcapng")
            check_size(size, kind, self.name, self._start + at)
            if at + size > len(data):
                if not self._reaches(size):
                    return self._end()
                at, data = self._at, self._data
            end = at + size
            if data[end - 4 : end] != data[at + 4 : at + 8]:
                raise damaged(self.name, self._start + at, "lengths-differ")
            self._at = end
            yield StoredBlock(self._start + at, kind, self._order, data[at:end])

    def _end(self) -> None:
        """Note what is missing, if a block has begun."""
        place = self._start + self._at
        if place == 0 and not self.incomplete:
            raise damaged(self.name, 0, "not-pcapng")
        if self._data[self._at :] and not self.incomplete:
            self.incomplete = f"the file ends in the middle of a block, from byte {place}"

    def _skip_damage(self) -> None:
        """Go to the next whole block, or to the end.

        If the header of a section is lost, so are its blocks: nothing else describes them.
        """
        begin, pattern = self._start + self._at, _pattern(self._order, _KINDS)
        while True:
            if found := pattern.search(self._data, self._at):
                self._at = found.start()
                if self._start + self._at > begin and self._is_at_block():
                    return
                if found[0] == _SECTION:
                    pattern = _pattern(self._order, (blocks.SECTION,))
                self._at += 1
                continue
            # The start of a block may be cut.
            self._at = max(self._at, len(self._data) - 3)
            if not self._reaches(len(self._data) - self._at + 1):
                self._at = len(self._data)
                return

    def _is_at_block(self) -> bool:
        """Return whether a whole block begins here."""
        if not self._reaches(SMALLEST_BLOCK):
            return False
        head = self._data[self._at : self._at + SMALLEST_BLOCK]
        order = _ORDERS.get(head[8:]) if head[:4] == _SECTION else self._order
        size = struct.unpack(order + "I", head[4:8])[0] if order else 0
        legal = size % 4 == 0 and SMALLEST_BLOCK <= size <= LARGEST_BLOCK
        if not legal or not self._reaches(size):
            return False
        end = self._at + size
        return self._data[end - 4 : end] == head[4:8]

    def _reaches(self, size: int) -> bool:
        """Read until ``size`` bytes follow, or the file ends; return whether they do."""
        missing = size - (len(self._data) - self._at)
        if missing <= 0 or self._ended:
            return missing <= 0
        parts = [self._data[self._at :]]
        try:
            while missing > 0 and not self._ended:
                more = self._file.read(max(missing, _READ))
                parts.append(more)
                missing -= len(more)
                self._ended = not more
                self._progress(len(more))
        except CaptureError as error:
            self._ended, self.incomplete = True, error.detail
        except OSError as error:
            raise LinkError(self.name, f"reading failed: {error.strerror or error}") from error
        self._start += self._at
        self._data, self._at = b"".join(parts), 0
        return missing <= 0


def _pattern(order: str, kinds: Iterable[int]) -> re.Pattern[bytes]:
    return re.compile(b"|".join(re.escape(struct.pack(order + "I", kind)) for kind in kinds))


@contextmanager
def block_file(
    path: str | os.PathLike[str],
    progress: Progress = lambda size: None,
    lose: Lose | None = None,
) -> Iterator[BlockFile]:
    """Open a recording, compressed or not.

    ``progress`` gets the size of each read. With ``lose``, iteration continues after damage: at the
    next block that is whole. ``lose`` is called with each range of bytes in between.
    """
    with closing(open_capture(path)) as file:
        yield BlockFile(file, str(path), progress, lose)
