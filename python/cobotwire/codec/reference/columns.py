"""Decode a stream into columns, value by value."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from threading import RLock
from typing import Any

from cobotwire.codec.cell_types import cell_type
from cobotwire.codec.columns import Columns, Rows, Scan
from cobotwire.codec.events import DecodedMessage, Event, Frame, Noise
from cobotwire.codec.interface import Data
from cobotwire.codec.reference.framer import ReferenceFramer
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.rejection import reject_shared
from cobotwire.protocol.table import Direction, Field, Table, Variant


class ReferenceColumnReader:
    """Decodes a stream into columns; see :class:`cobotwire.codec.interface.ColumnReader`."""

    def __init__(self, table: Table, framer: ReferenceFramer, raw: bool) -> None:
        self._table = table
        self._framer = framer
        self._raw = raw
        self._noise = Noises()
        # Reentrant: a thread can go on even if an interrupt kept it from releasing the lock.
        self._in_use = RLock()

    @property
    def pending(self) -> int:
        """The number of fed bytes that wait for more."""
        with self._exclusively():
            return self._framer.pending

    def feed(self, data: Data) -> Columns:
        """Take bytes; return the rows and noise that became certain since the last call."""
        with self._exclusively():
            return self._columns(self._framer.feed(data))

    def flush(self) -> Columns:
        """Stop waiting for more bytes; return the remaining rows and noise."""
        with self._exclusively():
            return self._columns(self._framer.flush(), at_end=True)

    @contextmanager
    def _exclusively(self) -> Iterator[None]:
        """Hold the reader for one call.

        Raises:
            UsageError: another thread uses the reader.
        """
        if not self._in_use.acquire(blocking=False):
            raise reject_shared("column reader")
        try:
            yield
        finally:
            self._in_use.release()

    def all_of(self, data: Data) -> Columns:
        """Return the columns of a stream."""
        return self._columns([*self._framer.feed(data), *self._framer.flush()], at_end=True)

    def _columns(self, events: list[Event], at_end: bool = False) -> Columns:
        rows: dict[tuple[int, Direction, int], tuple[Any, Any, list[Any]]] = {}
        rejected = array("Q")
        for event in events:
            self._noise.take(event)
            if not isinstance(event, Frame):
                continue
            try:
                message = event.message
            except ProtocolError:
                rejected.append(event.offset)
                continue
            variants = message.command.variants(message.direction)
            # By identity, because two variants of a command may be equal.
            index = next(i for i, each in enumerate(variants) if each is message.variant)
            key = (self._table.commands.index(message.command), message.direction, index)
            offset, address, columns = rows.setdefault(
                key, (array("Q"), array("B"), self._empty(message.variant))
            )
            offset.append(event.offset)
            if message.address is not None:
                address.append(message.address)
            values = self._values(event, message)
            for column, value in zip(columns, values):
                column.extend(value)
        return Columns(
            self._table,
            [self._rows(key, *found) for key, found in sorted(rows.items(), key=self._order)],
            rejected,
            self._noise.completed(at_end),
            self._framer.counters,
            self._raw,
        )

    def _values(self, frame: Frame, message: DecodedMessage) -> Sequence[Any]:
        variant, values = message.variant, message.values
        rows = variant.unpack(self._table.frame.data(frame.data, message.direction))
        if self._raw:
            return rows
        return [
            [number.physical(raw) for number, raw in zip(variant.case(field, values).numbers, row)]
            for field, row in zip(variant.fields, rows)
        ]

    def _empty(self, variant: Variant) -> list[Any]:
        return [array(cell_type(field, self._raw)) for field in variant.fields]

    def _order(self, item: tuple[tuple[int, Direction, int], object]) -> tuple[int, bool, int]:
        (command, direction, variant), _ = item
        return command, direction == "reply", variant

    def _rows(
        self, key: tuple[int, Direction, int], offset: Any, address: Any, columns: list[Any]
    ) -> Rows:
        index, direction, variant = key
        command = self._table.commands[index]
        fields = command.variants(direction)[variant].fields
        shaped = [shape(field, column, len(offset)) for field, column in zip(fields, columns)]
        addresses = address if self._table.frame.addresses else None
        return Rows(self._table, command, direction, variant, offset, shaped, addresses)


class Noises:
    """Joins adjacent noise across events and calls; a frame completes a span."""

    def __init__(self) -> None:
        self._offset, self._size = array("Q"), array("Q")
        self._open = False

    def take(self, event: Event) -> None:
        """Add the noise of an event, or complete the span if the event is a frame."""
        if isinstance(event, Noise) and self._open:
            self._size[-1] += len(event.data)
        elif isinstance(event, Noise):
            self._offset.append(event.offset)
            self._size.append(len(event.data))
        self._open = isinstance(event, Noise)

    def completed(self, at_end: bool) -> tuple[Any, Any]:
        """Return the spans completed since the last call."""
        end = len(self._offset) - (1 if self._open and not at_end else 0)
        self._open = self._open and not at_end
        completed = self._offset[:end], self._size[:end]
        del self._offset[:end], self._size[:end]
        return completed


def scan(events: Iterable[Event], framer: ReferenceFramer) -> Scan:
    """Return the offsets of the frames and the noise."""
    offset, noise = array("Q"), Noises()
    for event in events:
        noise.take(event)
        if isinstance(event, Frame):
            offset.append(event.offset)
    return Scan(offset, noise.completed(at_end=True), framer.counters)


def shape(field: Field, column: Any, rows: int) -> Any:
    """Return a column, with two dimensions if the field is a row of numbers."""
    if not field.many or not len(column):
        return column
    return memoryview(column).cast("B").cast(column.typecode, (rows, len(column) // rows))
