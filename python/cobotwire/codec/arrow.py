"""Rows as an Arrow table, on the same memory. The only importer of pyarrow."""

from __future__ import annotations

from typing import Any

import pyarrow as pa

from cobotwire.codec.columns import Rows

# A memoryview's format, as the type that Arrow knows.
TYPES = {
    "d": pa.float64(),
    "b": pa.int8(),
    "B": pa.uint8(),
    "h": pa.int16(),
    "H": pa.uint16(),
    "i": pa.int32(),
    "I": pa.uint32(),
    "q": pa.int64(),
    "Q": pa.uint64(),
}


def table_of(rows: Rows) -> pa.Table:
    """The rows as a table: ``offset``, then a column for each field.

    A row of ``k`` numbers is a fixed-size list; each field carries its unit as metadata, or units,
    where its numbers have several.
    """
    fields = [pa.field("offset", pa.uint64(), nullable=False)]
    arrays = [_array(rows.offset)]
    for field in rows.layout.fields:
        array = _array(rows[field.name])
        units = dict.fromkeys(number.unit for case in field.cases for number in case.numbers)
        metadata = {"unit": ", ".join(units)} if any(units) else None
        fields.append(pa.field(field.name, array.type, nullable=False, metadata=metadata))
        arrays.append(array)
    metadata = {"command": rows.command.name, "direction": rows.direction, "form": str(rows.form)}
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata=metadata))


def _array(column: memoryview) -> Any:
    shape = column.shape or (0,)
    size = column.nbytes // column.itemsize
    flat = pa.Array.from_buffers(TYPES[column.format], size, [None, pa.py_buffer(column)])
    return flat if len(shape) == 1 else pa.FixedSizeListArray.from_arrays(flat, shape[1])
