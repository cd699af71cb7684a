"""Divide inputs into pieces; one task reads each piece."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from typing import NamedTuple

from cobotwire.capture.archive.stored import Stored
from cobotwire.capture.export.batch import Batch
from cobotwire.capture.export.inputs import COMPRESSED, Input, Inputs
from cobotwire.capture.export.opening import InputStream
from cobotwire.capture.export.plan import ExportPlan
from cobotwire.capture.export.sources import Source
from cobotwire.codec.segments import Divider, decode_segment, even_cuts
from cobotwire.protocol.errors import UnreadableInput, UsageError

# The bytes that a task decodes at a time.
CHUNK = 16 << 20


class Piece(NamedTuple):
    """What one task reads: a part of raw bytes, or a whole input.

    Attributes:
        input: the input.
        number: the number of the part, from 0 on.
        size: the size of each part except the last, in bytes; 0 if the input is not divided.
    """

    input: Input
    number: int = 0
    size: int = 0

    @property
    def bytes(self) -> int:
        """The number of stored bytes; 0 if it is not known."""
        total = self.input.size or 0
        return min(self.size, total - self.number * self.size) if self.size else total

    def batches(self, plan: ExportPlan, source: Source) -> Iterator[Batch]:
        """Yield the chosen rows, and count them in the report of the source.

        Raises:
            UsageError: as :meth:`Source.batches`.
            LinkError: as :meth:`Source.batches`, or the input has become shorter.
        """
        if not self.size:
            yield from source.batches(self.input)
            return
        codec = plan.editions.codec("")
        with Stored(self.input) as stored:
            cuts = even_cuts(stored.size, self.size)
            segment = Divider(codec, plan.direction, stored, cuts).segment(self.number)
            parts = decode_segment(codec, plan.direction, stored, segment, chunk=CHUNK)
            yield from source.decoded(self.input, parts, first=self.number == 0)


def divide(inputs: Inputs, size: int, read_as: str = "") -> tuple[Piece, ...]:
    """Return the pieces of all inputs, in their order; ``read_as`` is as in the plan.

    Raw bytes are divided. Recordings, compressed files and files of other programs are read whole,
    one task for each.

    Raises:
        UsageError: ``size`` is not positive, or an input cannot be opened.
        LinkError: an input cannot be read.
    """
    if size < 1:
        raise UsageError("piece_bytes", size, "1 and more")
    return tuple(piece for input in inputs.files for piece in _pieces(input, size, read_as))


def _pieces(input: Input, size: int, read_as: str) -> Iterator[Piece]:
    if input.size is None or input.size <= size or not _is_raw(input, read_as):
        yield Piece(input)
        return
    for number in range(-(-input.size // size)):
        yield Piece(input, number, size)


def _is_raw(input: Input, read_as: str) -> bool:
    if input.url.endswith(tuple(COMPRESSED)):
        return False
    try:
        with closing(InputStream(input, lambda size: None, read_as or None)) as stream:
            return stream.found.reader is None and not stream.found.recording
    except UnreadableInput:
        # The task that reads this input reports the error.
        return False
