"""A frame taken apart into numbers, so that any of them can be sent wrong."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from cobotwire.codec.interface import Message
from cobotwire.codec.reference.check import check
from cobotwire.codec.reference.decode import picked_case, whole
from cobotwire.table import FrameFormat, Number


@dataclass(frozen=True, slots=True)
class Cell:
    """One number on the wire: how it is written, and the whole number that is."""

    number: Number
    whole: int

    @property
    def data(self) -> bytes:
        """Its bytes. What the width has no room for is cut off, as firmware in C does."""
        width = self.number.width
        return (self.whole % (1 << 8 * width)).to_bytes(width, self.number.order)


def take_apart(frame: FrameFormat, message: Message, data: bytes) -> list[list[Cell]]:
    """The cells of each field of a whole frame that was decoded as ``message``."""
    fields: list[list[Cell]] = []
    offset = frame.overhead + 1
    for field in message.layout.fields:
        cells = []
        # The picked case says how the field's bytes are cut.
        for number in picked_case(frame, message.layout, field, data).numbers:
            cells.append(Cell(number, whole(number, data, offset)))
            offset += number.width
        fields.append(cells)
    return fields


def joined(fields: Iterable[Iterable[Cell]]) -> bytes:
    """The data bytes of a frame with these cells."""
    return b"".join(cell.data for cells in fields for cell in cells)


def framed(frame: FrameFormat, id: int, data: bytes, length: int | None = None) -> bytes:
    """A frame; ``length`` is written as LEN whatever the data's size is, when it is given."""
    told = frame.length(len(data)) if length is None else length
    body = frame.header + bytes(frame.addresses[:1]) + bytes([told % 256, id % 256]) + data
    return body + check(frame, body)
