"""Hold the messages of a stream as columns: one for each field, in the order of the stream."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, overload

from cobotwire.codec.cell_types import cell_type
from cobotwire.codec.events import Counters
from cobotwire.codec.table_columns import column_name
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Direction, Table, Variant

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Buffer

    from cobotwire.codec.arrow import VariantRows

    Arrays = dict[str, np.ndarray[Any, Any]]


class Spans(NamedTuple):
    """The spans of noise in a stream; adjacent spans are joined.

    ``offset`` and ``size`` are one-dimensional memoryviews of 64-bit unsigned integers: the start
    of each span in the stream, and its size in bytes.
    """

    offset: memoryview
    size: memoryview


class Scan:
    """The offsets of the frames and the noise in a stream; ``counters`` counts both."""

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
    numbers: a list of groups has the numbers of all its groups in a row. It has one dimension if it
    is empty. ``offset`` holds 64-bit unsigned integers, and ``address`` 8-bit ones. Fields hold
    physical values as float64; with ``raw`` they hold raw values, in the smallest integer type for
    the values that the field allows. Bytes and texts are 8-bit unsigned integers. NumPy and Arrow
    use the same memory.
    """

    def __init__(
        self,
        table: Table,
        command: Command,
        direction: Direction,
        variant_index: int,
        offset: Buffer,
        columns: Sequence[Buffer],
        address: Buffer | None,
    ) -> None:
        self.table = table
        self.command = command
        self.direction: Direction = direction
        self.variant_index = variant_index
        self._offset = offset
        self._columns = columns
        self._address = address

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

    @property
    def address(self) -> memoryview | None:
        """The address byte of each message; None if frames of the edition have no address."""
        return None if self._address is None else memoryview(self._address)

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

    def to_numpy(self) -> Arrays:
        """Return the columns by name as arrays that share memory: offset, address, the fields.

        ``address`` exists only if frames have an address byte. An array has a dimension more for a
        field of several numbers, and two more for a list of groups or texts, also if there are no
        rows. Bytes and texts are arrays of ``uint8``.

        Raises:
            ImportError: NumPy (the extra ``numpy``) is not installed.
        """
        import numpy as np

        rows = len(self)
        arrays = {"offset": np.asarray(self.offset)}
        if self.address is not None:
            arrays["address"] = np.asarray(self.address)
        for field, column in zip(self.variant.fields, self._columns):
            shape = (rows, *field.dimensions)
            arrays[column_name(field.name, self.direction)] = np.asarray(
                memoryview(column)
            ).reshape(shape)
        return arrays

    def to_arrow(self, *, wide: bool = False, leading: Mapping[str, Any] | None = None) -> Any:
        """Return the rows as a ``pyarrow.Table`` that shares memory where the types allow it.

        The columns are ``offset`` and one for each field: floats are ``float64``, integers
        ``int64``, flags ``bool``, enums dictionaries of their names, bytes ``binary``, texts
        ``utf8``; rows of numbers are fixed-size lists. With ``wide`` each number of a row has a
        column of its own: ``j1`` to ``j6``. The metadata of an Arrow field has its ``unit``. Raw
        values are integers.

        If frames have an address byte, the column ``address`` follows ``offset``: a dictionary of
        the names of the devices.

        ``leading`` takes the place of ``offset``: columns by name, each a pyarrow array or a buffer
        of numbers, with one element for each row. ``address`` follows the column ``offset`` in
        them, or all of them if they have none.

        Raises:
            ImportError: pyarrow (the extra ``arrow``) is not installed.
            UsageError: a leading column has another number of rows, or the name of another column.
        """
        from cobotwire.codec.arrow import arrow_table
        from cobotwire.codec.arrow_layout import Layout

        raw = all(memoryview(column).format != "d" for column in self._columns)
        layout = Layout(self.table, self.command, self.direction, (self.variant,), raw, wide)
        metadata = {
            "command": self.command.name,
            "direction": self.direction,
            "variant": str(self.variant_index),
        }
        return arrow_table(layout, [self._variant_rows(leading)], metadata)

    def _variant_rows(self, leading: Mapping[str, Any] | None) -> VariantRows:
        from cobotwire.codec.arrow import VariantRows
        from cobotwire.codec.arrow_addresses import with_address

        columns = [memoryview(column) for column in self._columns]
        first = {"offset": self.offset} if leading is None else leading
        if self.address is not None:
            first = with_address(first, self.table, self.address)
        return VariantRows(self.variant, self.offset, columns, first)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """Return the Arrow PyCapsule stream, which polars, DuckDB, pandas and pyarrow read.

        It has the columns of :meth:`to_arrow`.

        Raises:
            ImportError: pyarrow (the extra ``arrow``) is not installed.
        """
        return self.to_arrow().__arrow_c_stream__(requested_schema)


class Columns(Sequence[Rows]):
    """The messages of a stream: the rows of each variant that occurred, in the order of the table.

    ``table`` is the edition's, and ``raw`` is whether the columns hold raw values. ``counters``
    accounts for every byte since the start of the stream. ``noise`` holds the spans of bytes that
    belong to no frame. ``rejected`` holds the offsets of legal frames with a value that the edition
    does not allow. These frames are in no rows; decoding one raises the error.
    """

    def __init__(
        self,
        table: Table,
        rows: Sequence[Rows],
        rejected: Buffer,
        noise: tuple[Buffer, Buffer],
        counters: Counters,
        raw: bool = False,
    ) -> None:
        self.table = table
        self.raw = raw
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
            UsageError: there is no such command or variant, or several variants occurred.
        """
        variants = self.table.command(command).variants(direction)
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
        empty = memoryview(b"").cast("Q")
        codes: list[Any] = [cell_type(field, self.raw) for field in variants[chosen].fields]
        columns = [memoryview(b"").cast(code) for code in codes]
        address = memoryview(b"") if self.table.frame.addresses else None
        return Rows(
            self.table, self.table.command(command), direction, chosen, empty, columns, address
        )

    def to_arrow(
        self,
        command: str,
        direction: Direction = "reply",
        *,
        wide: bool = False,
        leading: Callable[[Rows], Mapping[str, Any]] | None = None,
    ) -> Any:
        """Return all rows of one message as a ``pyarrow.Table``, in the order of the stream.

        The columns are those of :meth:`Rows.to_arrow`, for all variants together: a value that a
        variant lacks is null. Their names, types and order depend on the message only, so tables of
        several captures, or without rows, can be joined. ``leading`` returns the leading columns of
        the rows of one variant, which take the place of ``offset``.

        Raises:
            ImportError: pyarrow (the extra ``arrow``) is not installed.
            UsageError: there is no such command, or two variants have a field of the same name with
                types that have nothing in common.
        """
        from cobotwire.codec.arrow import arrow_table
        from cobotwire.codec.arrow_layout import Layout

        first = self.rows(command, direction, 0)
        found = [
            rows for rows in self if rows.command is first.command and rows.direction == direction
        ]
        found_rows = [rows._variant_rows(leading and leading(rows)) for rows in found or [first]]
        variants = first.command.variants(direction)
        layout = Layout(self.table, first.command, direction, variants, self.raw, wide)
        return arrow_table(layout, found_rows, {"command": command, "direction": direction})

    def __repr__(self) -> str:
        return f"<Columns {list(self._rows)!r}>"


def join_columns(buffers: Sequence[Buffer]) -> memoryview[Any]:
    """Return a copy of columns of one type, one after another."""
    views = [memoryview(buffer) for buffer in buffers]
    filled = [view for view in views if view.nbytes]
    if len(filled) < 2:
        return filled[0] if filled else views[0]
    code: Any = filled[0].format
    joined = memoryview(b"".join([view.tobytes() for view in filled]))
    _, *across = filled[0].shape or ()
    return joined.cast(code, (sum(map(len, filled)), *across)) if across else joined.cast(code)


def join_rows(found: Sequence[Rows]) -> Rows:
    """Return a copy of rows of one variant, one after another."""
    first = found[0]
    addresses = [rows._address for rows in found if rows._address is not None]
    return Rows(
        first.table,
        first.command,
        first.direction,
        first.variant_index,
        join_columns([rows._offset for rows in found]),
        [join_columns(columns) for columns in zip(*[rows._columns for rows in found])],
        join_columns(addresses) if addresses else None,
    )


def stamp_arrays(
    time: memoryview, direction: memoryview, names: Sequence[str], interface: memoryview
) -> Arrays:
    """Return as arrays when and where messages were captured; ``direction`` indexes ``names``."""
    import numpy as np

    return {
        "time": np.asarray(time).view("datetime64[ns]"),
        "direction": np.asarray(names)[np.asarray(direction)],
        "interface": np.asarray(interface),
    }
