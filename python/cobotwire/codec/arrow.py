"""Make an Arrow table of columns, on the same memory. No other module imports pyarrow."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pyarrow as pa

from cobotwire.protocol.fields import Field

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
# Longer columns of bytes, texts or lists need offsets of 64 bits.
LARGEST = 2**31 - 1


def arrow_table(
    offset: memoryview,
    columns: Sequence[tuple[Field, memoryview]],
    metadata: Mapping[str, str],
) -> pa.Table:
    """Return the columns of some rows as a table without nulls; ``offset`` is the first column.

    Numbers, bytes, and texts without padding stay where they are. Each field carries its units as
    metadata.
    """
    arrays = [_flat(offset)]
    fields = [pa.field("offset", arrays[0].type, nullable=False)]
    for field, column in columns:
        array = _array(field, column, len(offset))
        units = dict.fromkeys(number.unit for number in field.numbers)
        described = {"unit": ", ".join(units)} if any(units) else None
        fields.append(pa.field(field.name, array.type, nullable=False, metadata=described))
        arrays.append(array)
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata=dict(metadata)))


def in_order(streams: Iterable[Any]) -> pa.Table:
    """Return the rows of tables with the same columns in the order of their offsets."""
    table = pa.concat_tables([pa.table(stream) for stream in streams]).sort_by("offset")
    metadata = {key: text for key, text in table.schema.metadata.items() if key != b"variant"}
    return table.replace_schema_metadata(metadata)


def stamped_table(
    rows: Any, time: memoryview, direction: memoryview, names: Sequence[str], interface: memoryview
) -> pa.Table:
    """Return the table of some rows with three more columns in front: when and where.

    ``time`` has nanoseconds since 1970 (UTC), and ``direction`` indexes ``names``.
    """
    table = pa.table(rows)
    directions = pa.DictionaryArray.from_arrays(_flat(direction), pa.array(names))
    times = _flat(time).view(pa.timestamp("ns"))
    for name, column in (
        ("interface", _flat(interface)),
        ("direction", directions),
        ("time", times),
    ):
        table = table.add_column(0, pa.field(name, column.type, nullable=False), column)
    return table


def _array(field: Field, column: memoryview, rows: int) -> Any:
    """Return a column: a list or row of numbers becomes lists, bytes and text become values."""
    if not field.many:
        return _flat(column)
    count, *each = field.dimensions
    if field.kind == "bytes":
        return _spans(pa.binary(), pa.large_binary(), column, rows, count)
    if field.kind == "text" and not each:
        return _texts(field, column, rows, count)
    if field.kind == "text":
        elements = _texts(field, column, rows * count, *each)
    else:
        elements = _flat(column)
        if each:
            elements = _fixed(elements, each[0], rows * count)
    if field.sizes is None:
        return _fixed(elements, count, rows)
    # Variants with other numbers of elements have the same type.
    small = rows * count <= LARGEST
    lists = pa.ListArray if small else pa.LargeListArray
    offsets = pa.py_buffer(_offsets(rows, count, small))
    index = pa.Array.from_buffers(pa.int32() if small else pa.int64(), rows + 1, [None, offsets])
    return lists.from_arrays(index, elements)


def _flat(column: memoryview) -> Any:
    size = column.nbytes // column.itemsize
    return pa.Array.from_buffers(TYPES[column.format], size, [None, pa.py_buffer(column)])


def _fixed(elements: Any, size: int, rows: int) -> Any:
    """Return rows of ``size`` elements each."""
    type = pa.list_(elements.type, size)
    return pa.Array.from_buffers(type, rows, [None], children=[elements])


def _spans(small: Any, large: Any, column: memoryview, rows: int, size: int) -> Any:
    """Return values of ``size`` bytes each on the memory of a column."""
    fits = rows * size <= LARGEST
    buffers = [None, pa.py_buffer(_offsets(rows, size, fits)), pa.py_buffer(column)]
    return pa.Array.from_buffers(small if fits else large, rows, buffers)


def _offsets(rows: int, size: int, small: bool) -> array[int]:
    ends = range(0, rows * size + 1, size) if size else [0] * (rows + 1)
    return array("i" if small else "q", ends)


def _texts(field: Field, column: memoryview, rows: int, size: int) -> Any:
    if field.padding < 0 and field.encoding != "latin-1":
        return _spans(pa.utf8(), pa.large_utf8(), column, rows, size)
    data = column.tobytes()
    texts = [field.text(data[row * size : (row + 1) * size]) for row in range(rows)]
    fits = sum(map(len, texts)) * 2 <= LARGEST  # a Latin-1 letter has at most two bytes in UTF-8
    return pa.array(texts, pa.utf8() if fits else pa.large_utf8())
