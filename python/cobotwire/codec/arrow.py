"""Make an Arrow table of columns, on the same memory. No other module imports pyarrow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pyarrow as pa

# The Arrow type of each memoryview format.
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


def arrow_table(
    columns: Mapping[str, memoryview],
    units: Mapping[str, Sequence[str]],
    metadata: Mapping[str, str],
) -> pa.Table:
    """Return columns as a table on the same memory, without nulls.

    A two-dimensional column becomes fixed-size lists. Each field carries its units as metadata.
    """
    fields, arrays = [], []
    for name, column in columns.items():
        array = _array(column)
        found = units.get(name, ())
        described = {"unit": ", ".join(found)} if any(found) else None
        fields.append(pa.field(name, array.type, nullable=False, metadata=described))
        arrays.append(array)
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata=dict(metadata)))


def _array(column: memoryview) -> Any:
    shape = column.shape or (0,)
    size = column.nbytes // column.itemsize
    flat = pa.Array.from_buffers(TYPES[column.format], size, [None, pa.py_buffer(column)])
    return flat if len(shape) == 1 else pa.FixedSizeListArray.from_arrays(flat, shape[1])
