"""Make Arrow tables of messages. Only the modules ``arrow*`` of this package import pyarrow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from cobotwire.codec.arrow_addresses import ADDRESS, address_field
from cobotwire.codec.arrow_cells import LARGEST, cells, flat
from cobotwire.codec.arrow_layout import Layout
from cobotwire.codec.table_columns import TableColumn
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.fields import Variant


@dataclass(frozen=True, slots=True)
class VariantRows:
    """The rows of one variant of a message.

    Attributes:
        variant: the variant.
        offset: the start of each message in its stream, as 64-bit unsigned integers.
        columns: the numbers of each field, in the order of the fields.
        leading: the columns before the fields, by name: arrays, or buffers of numbers.
    """

    variant: Variant
    offset: memoryview
    columns: Sequence[memoryview]
    leading: Mapping[str, Any]

    def chunks(self) -> Iterator[VariantRows]:
        """Yield the rows in chunks that fit into Arrow's arrays."""
        rows = len(self.offset)
        longest = max([field.size for field in self.variant.fields], default=0)
        most = LARGEST // max(2 * longest, 1)  # a Latin-1 letter has at most two bytes in UTF-8
        if rows <= most:
            yield self
            return
        for start in range(0, rows, most):
            span = slice(start, min(start + most, rows))
            yield replace(
                self,
                offset=self.offset[span],
                columns=[_cut(column, rows, span) for column in self.columns],
                leading={name: as_array(values)[span] for name, values in self.leading.items()},
            )


def arrow_table(
    layout: Layout, variants: Sequence[VariantRows], metadata: Mapping[str, str]
) -> pa.Table:
    """Return the rows of variants as one table, in the order of their offsets.

    A value that a variant lacks is null. At least one variant must be given; it may have no rows.

    Raises:
        UsageError: a leading column has the name of another column, or another number of rows.
    """
    columns = [*layout.columns()]
    leading = [
        address_field(layout.table)
        if name == ADDRESS and layout.table.frame.addresses
        else pa.field(name, as_array(values).type, nullable=False)
        for name, values in variants[0].leading.items()
    ]
    names = {column.name for column, _ in columns}
    for field in leading:
        if field.name in names:
            message = f"the {layout.command.name} {layout.direction} has a column {field.name}"
            raise UsageError("leading", field.name, message=f"{message}: rename the leading one")
    schema = pa.schema([*leading, *[field for _, field in columns]], metadata=dict(metadata))
    chunks = [chunk for rows in variants for chunk in rows.chunks()]
    table = pa.concat_tables([_chunk_table(chunk, columns, schema) for chunk in chunks])
    if len(variants) == 1:
        return table
    offsets = pa.chunked_array([flat(chunk.offset) for chunk in chunks], pa.uint64())
    return table.take(pc.sort_indices(offsets))


def as_array(values: Any) -> Any:
    """Return an array, or the numbers of a buffer, as an Arrow array."""
    return values if isinstance(values, pa.Array) else flat(memoryview(values))


def times(nanoseconds: Any) -> Any:
    """Return a column of times in UTC from a buffer of 64-bit integers: nanoseconds since 1970."""
    return flat(memoryview(nanoseconds)).cast(pa.int64()).cast(pa.timestamp("ns", "UTC"))


def repeated(text: str, choices: Sequence[str], rows: int) -> Any:
    """Return a dictionary column with the same text in all rows, one of ``choices``.

    Tables of different texts have the same type if they have the same choices.
    """
    index = pa.repeat(pa.scalar(choices.index(text), pa.int8()), rows)
    return pa.DictionaryArray.from_arrays(index, pa.array(choices, pa.utf8()))


def stamps(
    time: memoryview, direction: memoryview, names: Sequence[str], interface: memoryview
) -> dict[str, Any]:
    """Return three leading columns: when and where messages were captured.

    ``time`` has nanoseconds since 1970 (UTC), and ``direction`` indexes ``names``.
    """
    directions = pa.DictionaryArray.from_arrays(flat(direction), pa.array(names, pa.utf8()))
    return {"time": times(time), "direction": directions, "interface": flat(interface)}


def in_order_of_time(tables: Sequence[pa.Table]) -> pa.Table:
    """Return the rows of tables with the same columns in the order of their times.

    Rows with the same time keep their order.
    """
    table = pa.concat_tables(tables)
    return table if len(tables) == 1 else table.take(pc.sort_indices(table["time"]))


def _chunk_table(
    chunk: VariantRows, columns: Sequence[tuple[TableColumn, Any]], schema: Any
) -> Any:
    rows = len(chunk.offset)
    arrays = [as_array(values) for values in chunk.leading.values()]
    for values, name in zip(arrays, chunk.leading):
        if len(values) != rows:
            message = f"the leading column {name} has {len(values)} rows, and the table {rows}"
            raise UsageError("leading", len(values), str(rows), message=message)
    for column, field in columns:
        found = column.find(chunk.variant)
        if found is None:
            arrays.append(pa.nulls(rows, field.type))
            continue
        index, part = found
        array = cells(chunk.variant.fields[index], chunk.columns[index], rows, part)
        arrays.append(array if array.type == field.type else array.cast(field.type))
    return pa.Table.from_arrays(arrays, schema=schema)


def _cut(column: memoryview, rows: int, span: slice) -> memoryview:
    """Return the numbers of some rows."""
    size = column.nbytes // rows
    part = column.cast("B")[span.start * size : span.stop * size]
    format: Any = column.format
    return part.cast(format)
