"""Whole captures as columns: one for each field of each message, in the order of the stream."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, overload

from cobotwire.codec.events import Counters
from cobotwire.errors import UsageError
from cobotwire.table import Command, Direction, Layout, Table

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Buffer


class Spans(NamedTuple):
    """The noise of a stream, adjacent stretches joined.

    ``offset`` and ``size`` are one-dimensional memoryviews of 64-bit unsigned integers: where each
    span starts in the stream, and its bytes.
    """

    offset: memoryview
    size: memoryview


class Scan:
    """Where the frames of a stream are, and the noise between them; ``counters`` are in numbers."""

    def __init__(self, offset: Buffer, noise: tuple[Buffer, Buffer], counters: Counters) -> None:
        self._offset = offset
        self._noise = noise
        self.counters = counters

    @property
    def offset(self) -> memoryview:
        """Where each frame starts: 64-bit unsigned integers."""
        return memoryview(self._offset)

    @property
    def noise(self) -> Spans:
        """Where the noise is."""
        offset, size = self._noise
        return Spans(memoryview(offset), memoryview(size))

    def __len__(self) -> int:
        return len(self.offset)


class Rows:
    """All messages of one form in a stream: a column of offsets and a column for each field.

    A column is a memoryview, of shape ``(n,)``, or ``(n, k)`` for a field that is a row of ``k``
    numbers. ``offset`` holds 64-bit unsigned integers; fields hold float64 in physical units, or,
    where raw numbers were asked for, the smallest integers that hold all that the field allows.
    Nothing is copied on the way to NumPy or Arrow.
    """

    def __init__(
        self,
        command: Command,
        direction: Direction,
        form: int,
        offset: Buffer,
        columns: Sequence[Buffer],
    ) -> None:
        self.command = command
        self.direction: Direction = direction
        self.form = form
        self._offset = offset
        self._columns = columns

    @property
    def layout(self) -> Layout:
        """The form's fields."""
        return self.command.layouts(self.direction)[self.form]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the fields' columns."""
        return tuple(field.name for field in self.layout.fields)

    @property
    def offset(self) -> memoryview:
        """Where each message starts in the stream."""
        return memoryview(self._offset)

    def __len__(self) -> int:
        return len(self.offset)

    def __getitem__(self, name: str) -> memoryview[Any]:
        """A field's column.

        Raises:
            UsageError: the form has no such field.
        """
        if name not in self.names:
            fields = ", ".join(self.names) or "none: it has no fields"
            raise UsageError(f"column of {self.command.name}", name, fields)
        return memoryview(self._columns[self.names.index(name)])

    def __repr__(self) -> str:
        return f"<Rows {self.command.name} {self.direction} {self.form}: {len(self)}>"

    def to_numpy(self) -> dict[str, np.ndarray[Any, Any]]:
        """The columns as arrays on the same memory, by name; ``offset`` among them.

        Raises:
            ImportError: NumPy, the extra ``numpy``, is not installed.
        """
        import numpy as np

        named = {"offset": self.offset} | {name: self[name] for name in self.names}
        return {name: np.asarray(column) for name, column in named.items()}

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The Arrow PyCapsule stream: polars, DuckDB, pandas and pyarrow take rows as they are.

        Raises:
            ImportError: pyarrow, the extra ``arrow``, is not installed.
        """
        from cobotwire.codec.arrow import table_of

        return table_of(self).__arrow_c_stream__(requested_schema)


class Columns(Sequence[Rows]):
    """What a stream holds: the rows of each form that came, in the order of the table.

    ``counters`` account for every byte, since the start of the stream; ``noise`` says where the
    bytes are that belong to no frame. ``refused`` is a memoryview of the offsets of frames that are
    legal but hold a value that the edition does not allow: they are in no row, and decoding one
    tells why.
    """

    def __init__(
        self,
        table: Table,
        rows: Sequence[Rows],
        refused: Buffer,
        noise: tuple[Buffer, Buffer],
        counters: Counters,
    ) -> None:
        self._table = table
        self._rows = rows
        self._refused = refused
        self._noise = noise
        self.counters = counters

    @property
    def refused(self) -> memoryview:
        """Where the frames start whose values the edition does not allow."""
        return memoryview(self._refused)

    @property
    def noise(self) -> Spans:
        """Where the noise is."""
        offset, size = self._noise
        return Spans(memoryview(offset), memoryview(size))

    def __len__(self) -> int:
        return len(self._rows)

    @overload
    def __getitem__(self, index: int) -> Rows: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Rows]: ...
    def __getitem__(self, index: int | slice) -> Rows | Sequence[Rows]:
        return self._rows[index]

    def __iter__(self) -> Iterator[Rows]:
        return iter(self._rows)

    def rows(self, command: str, direction: Direction = "reply", form: int | None = None) -> Rows:
        """The rows of one message; none, if it did not come.

        ``form`` picks one of several forms by its index; without it there must be only one that
        came.

        Raises:
            UsageError: no such command or form, or several forms came.
        """
        layouts = self._table.command(command).layouts(direction)
        legal = range(len(layouts))
        if not legal or (form is not None and form not in legal):
            allowed = ", ".join(map(str, legal)) or f"none: it has no framed {direction}"
            raise UsageError(f"form of {command} {direction}", form, allowed)
        found = [
            rows
            for rows in self
            if rows.command.name == command
            and rows.direction == direction
            and form in (None, rows.form)
        ]
        if len(found) > 1:
            came = " or ".join(str(rows.form) for rows in found)
            raise UsageError(f"form of {command} {direction}", form, f"{came}: all of them came")
        if found:
            return found[0]
        chosen = form or 0
        # One-dimensional also for rows of numbers: a memoryview has no other empty shape.
        empty = memoryview(b"").cast("Q")
        columns = [memoryview(b"").cast("d") for _ in layouts[chosen].fields]
        return Rows(self._table.command(command), direction, chosen, empty, columns)

    def __repr__(self) -> str:
        return f"<Columns {list(self._rows)!r}>"
