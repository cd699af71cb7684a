"""Hold the messages of a stream as columns: one for each field, in the order of the stream."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, overload

from cobotwire.codec.events import Counters
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Direction, Table, Variant

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Buffer


class Spans(NamedTuple):
    """The spans of noise in a stream; adjacent spans are joined.

    ``offset`` and ``size`` are one-dimensional memoryviews of 64-bit unsigned integers: the start
    of each span in the stream, and its size in bytes.
    """

    offset: memoryview
    size: memoryview


class Scan:
    """The places of the frames and the noise in a stream; ``counters`` counts both."""

    def __init__(self, offset: Buffer, noise: tuple[Buffer, Buffer], counters: Counters) -> None:
        self._offset = offset
        self._noise = noise
        self.counters = counters

    @property
    def offset(self) -> memoryview:
        """The start of each frame in the stream, as 64-bit unsigned integers."""
        return memoryview(self._offset)

    @property
    def noise(self) -> Spans:
        """The spans of noise."""
        offset, size = self._noise
        return Spans(memoryview(offset), memoryview(size))

    def __len__(self) -> int:
        return len(self.offset)


class Rows:
    """All messages of one variant in a stream: a column of offsets and a column for each field.

    A column is a memoryview of shape ``(n,)``, or ``(n, k)`` for a field that is a row of ``k``
    numbers. ``offset`` holds 64-bit unsigned integers. Fields hold physical values as float64; with
    ``raw`` they hold raw values, in the smallest integer type for the values that the field allows.
    NumPy and Arrow use the same memory.
    """

    def __init__(
        self,
        command: Command,
        direction: Direction,
        variant_index: int,
        offset: Buffer,
        columns: Sequence[Buffer],
    ) -> None:
        self.command = command
        self.direction: Direction = direction
        self.variant_index = variant_index
        self._offset = offset
        self._columns = columns

    @property
    def variant(self) -> Variant:
        """The variant of the messages, with its fields."""
        return self.command.variants(self.direction)[self.variant_index]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the fields' columns."""
        return tuple(field.name for field in self.variant.fields)

    @property
    def offset(self) -> memoryview:
        """The start of each message in the stream."""
        return memoryview(self._offset)

    def __len__(self) -> int:
        return len(self.offset)

    def __getitem__(self, name: str) -> memoryview[Any]:
        """Return the column of a field.

        Raises:
            UsageError: the variant has no such field.
        """
        if name not in self.names:
            what = f"{self.command.name} {self.direction}"
            message = f"{what} has no column {name!r}; choose from {', '.join(self.names)}"
            if not self.names:
                message = f"{what} has no fields"
            raise UsageError("column", name, message=message)
        return memoryview(self._columns[self.names.index(name)])

    def __repr__(self) -> str:
        return f"<Rows {self.command.name} {self.direction} {self.variant_index}: {len(self)}>"

    def to_numpy(self) -> dict[str, np.ndarray[Any, Any]]:
        """Return the columns as arrays on the same memory, by name, ``offset`` included.

        Raises:
            ImportError: NumPy (the extra ``numpy``) is not installed.
        """
        import numpy as np

        return {name: np.asarray(column) for name, column in self._by_name().items()}

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """Return the Arrow PyCapsule stream, which polars, DuckDB, pandas and pyarrow read.

        Each field's unit is its metadata.

        Raises:
            ImportError: pyarrow (the extra ``arrow``) is not installed.
        """
        from cobotwire.codec.arrow import arrow_table

        fields = self.variant.fields
        units = {f.name: tuple(dict.fromkeys([n.unit for n in f.numbers])) for f in fields}
        metadata = {
            "command": self.command.name,
            "direction": self.direction,
            "variant": str(self.variant_index),
        }
        return arrow_table(self._by_name(), units, metadata).__arrow_c_stream__(requested_schema)

    def _by_name(self) -> dict[str, memoryview]:
        return {"offset": self.offset} | {name: self[name] for name in self.names}


class Columns(Sequence[Rows]):
    """The messages of a stream: the rows of each variant that occurred, in the order of the table.

    ``counters`` accounts for every byte since the start of the stream. ``noise`` holds the spans of
    bytes that belong to no frame. ``rejected`` holds the offsets of legal frames with a value that
    the edition does not allow. These frames are in no rows; decoding one raises the error.
    """

    def __init__(
        self,
        table: Table,
        rows: Sequence[Rows],
        rejected: Buffer,
        noise: tuple[Buffer, Buffer],
        counters: Counters,
    ) -> None:
        self._table = table
        self._rows = rows
        self._rejected = rejected
        self._noise = noise
        self.counters = counters

    @property
    def rejected(self) -> memoryview:
        """The offsets of the legal frames with a value that the edition does not allow."""
        return memoryview(self._rejected)

    @property
    def noise(self) -> Spans:
        """The spans of noise."""
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

    def rows(
        self, command: str, direction: Direction = "reply", variant: int | None = None
    ) -> Rows:
        """Return the rows of one message; empty rows if it did not occur.

        ``variant`` picks one of several variants by its index. It is required only if several of
        them occurred.

        Raises:
            UsageError: there is no command or variant of that name, or several variants occurred.
        """
        variants = self._table.command(command).variants(direction)
        legal = range(len(variants))
        argument = f"variant of {command} {direction}"
        if not legal:
            raise UsageError(argument, variant, message=f"{command} has no {direction} in a frame")
        if variant is not None and variant not in legal:
            raise UsageError(argument, variant, ", ".join(map(str, legal)))
        found = [
            rows
            for rows in self
            if rows.command.name == command
            and rows.direction == direction
            and variant in (None, rows.variant_index)
        ]
        if len(found) > 1:
            occurred = " and ".join([str(rows.variant_index) for rows in found])
            message = f"variants {occurred} of the {command} {direction} occurred"
            message += ": choose one with variant="
            raise UsageError(argument, variant, occurred, message=message)
        if found:
            return found[0]
        chosen = variant or 0
        # One-dimensional even for rows of numbers: an empty memoryview has no other shape.
        empty = memoryview(b"").cast("Q")
        columns = [memoryview(b"").cast("d") for _ in variants[chosen].fields]
        return Rows(self._table.command(command), direction, chosen, empty, columns)

    def __repr__(self) -> str:
        return f"<Columns {list(self._rows)!r}>"
