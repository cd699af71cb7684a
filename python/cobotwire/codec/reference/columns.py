"""Columns, one value after the other."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Sequence
from typing import Any

from cobotwire.codec.columns import Columns, Rows, Scan
from cobotwire.codec.events import Event, Frame, Noise
from cobotwire.codec.interface import Data
from cobotwire.codec.reference.decode import whole_numbers
from cobotwire.codec.reference.framer import ReferenceFramer
from cobotwire.errors import ProtocolError
from cobotwire.table import Direction, Field, Layout, Table

# The integer types a raw column can have, the smallest first, unsigned before signed.
INTEGERS = (
    ("B", 0, 2**8 - 1),
    ("b", -(2**7), 2**7 - 1),
    ("H", 0, 2**16 - 1),
    ("h", -(2**15), 2**15 - 1),
    ("I", 0, 2**32 - 1),
    ("i", -(2**31), 2**31 - 1),
    ("q", -(2**63), 2**63 - 1),
)


class ReferenceColumnReader:
    """Decodes a stream into columns; see :class:`cobotwire.codec.interface.ColumnReader`."""

    def __init__(self, table: Table, framer: ReferenceFramer, raw: bool) -> None:
        self._table = table
        self._framer = framer
        self._raw = raw
        self._noise = Noises()

    @property
    def pending(self) -> int:
        """Bytes fed that are not accounted for yet."""
        return self._framer.pending

    def feed(self, data: Data) -> Columns:
        """Take bytes; give what is certain by now."""
        return self._columns(self._framer.feed(data))

    def flush(self) -> Columns:
        """Refute what still waits."""
        return self._columns(self._framer.flush(), at_end=True)

    def all_of(self, data: Data) -> Columns:
        """The columns of a whole stream."""
        return self._columns([*self._framer.feed(data), *self._framer.flush()], at_end=True)

    def _columns(self, events: list[Event], at_end: bool = False) -> Columns:
        rows: dict[tuple[int, Direction, int], tuple[Any, list[Any]]] = {}
        refused = array("Q")
        for event in events:
            self._noise.take(event)
            if not isinstance(event, Frame):
                continue
            try:
                message = event.message
            except ProtocolError:
                refused.append(event.offset)
                continue
            forms = message.command.layouts(message.direction)
            # By identity: two forms of a command may be equal in all but their place.
            form = next(i for i, layout in enumerate(forms) if layout is message.layout)
            key = (self._table.commands.index(message.command), message.direction, form)
            offset, columns = rows.setdefault(key, (array("Q"), self._empty(message.layout)))
            offset.append(event.offset)
            values = self._values(event, message.layout, message.values)
            for column, value in zip(columns, values):
                column.extend(value if isinstance(value, tuple) else (value,))
        return Columns(
            self._table,
            [self._rows(key, *found) for key, found in sorted(rows.items(), key=self._order)],
            refused,
            self._noise.given(at_end),
            self._framer.counters,
        )

    def _values(self, frame: Frame, layout: Layout, values: Sequence[Any]) -> Sequence[Any]:
        return whole_numbers(self._table.frame, layout, frame.data) if self._raw else values

    def _empty(self, layout: Layout) -> list[Any]:
        return [array(integer_type(field) if self._raw else "d") for field in layout.fields]

    def _order(self, item: tuple[tuple[int, Direction, int], object]) -> tuple[int, bool, int]:
        (command, direction, form), _ = item
        return command, direction == "reply", form

    def _rows(self, key: tuple[int, Direction, int], offset: Any, columns: list[Any]) -> Rows:
        index, direction, form = key
        command = self._table.commands[index]
        fields = command.layouts(direction)[form].fields
        shaped = [shape(field, column, len(offset)) for field, column in zip(fields, columns)]
        return Rows(command, direction, form, offset, shaped)


class Noises:
    """Joins noise over events and calls; a span is given once a frame has ended it."""

    def __init__(self) -> None:
        self._offset, self._size = array("Q"), array("Q")
        self._open = False

    def take(self, event: Event) -> None:
        """Note what an event tells of noise."""
        if isinstance(event, Noise) and self._open:
            self._size[-1] += len(event.data)
        elif isinstance(event, Noise):
            self._offset.append(event.offset)
            self._size.append(len(event.data))
        self._open = isinstance(event, Noise)

    def given(self, at_end: bool) -> tuple[Any, Any]:
        """The spans that are over, and were not given before."""
        end = len(self._offset) - (1 if self._open and not at_end else 0)
        self._open = self._open and not at_end
        given = self._offset[:end], self._size[:end]
        del self._offset[:end], self._size[:end]
        return given


def scan(events: Iterable[Event], framer: ReferenceFramer) -> Scan:
    """Where the frames are."""
    offset, noise = array("Q"), Noises()
    for event in events:
        noise.take(event)
        if isinstance(event, Frame):
            offset.append(event.offset)
    return Scan(offset, noise.given(at_end=True), framer.counters)


def shape(field: Field, column: Any, rows: int) -> Any:
    """A column of rows of numbers as two dimensions."""
    if not field.many:
        return column
    return memoryview(column).cast("B").cast(column.typecode, (rows, len(column) // rows))


def integer_type(field: Field) -> str:
    """The smallest integer type that holds all that the field allows, in any case."""
    numbers = [number for case in field.cases for number in case.numbers]
    bounds = field.choices or [n.minimum for n in numbers] + [n.maximum for n in numbers]
    return next(
        code for code, least, most in INTEGERS if least <= min(bounds) and max(bounds) <= most
    )
