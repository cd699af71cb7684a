"""Make Arrow arrays that share the memory of columns where the types allow it."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from cobotwire.codec.cell_types import cell_type
from cobotwire.protocol.fields import Field
from cobotwire.protocol.numbers import Number

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
# The most elements or bytes of an array: its offsets have 32 bits.
LARGEST = 2**31 - 1


def cells(field: Field, column: memoryview, rows: int, part: int | None = None) -> Any:
    """Return a field's column as an array; with ``part``, one of its numbers or texts.

    Floats, raw values, bytes, and texts without padding share the memory of the column, unless they
    are a part of a field. An array has room for ``LARGEST`` bytes of UTF-8.
    """
    if field.kind == "bytes":
        return _spans(pa.binary(), column, rows, *field.dimensions)
    if field.kind == "text":
        return _text_cells(field, column, rows, part)
    numbers = flat(column)
    if part is not None:
        numbers = pc.list_element(_fixed(numbers, len(field.cases[0].numbers), rows), part)
    values = _values(field, part, numbers)
    if part is not None or not field.many:
        return values
    if pa.types.is_dictionary(values.type):  # DuckDB ignores a dictionary in a list
        values = values.cast(pa.utf8())
    count, *each = field.dimensions
    return _lists(field, _fixed(values, each[0], rows * count) if each else values, rows, count)


def cells_type(field: Field, raw: bool, part: int | None = None) -> Any:
    """Return the type of the array that :func:`cells` makes of a field."""
    code: Any = cell_type(field, raw)
    return cells(field, memoryview(b"").cast(code), 0, part).type


def numbers_in(field: Field, part: int | None) -> tuple[Number, ...]:
    """Return the numbers of all cases of a field, or those of a part of it."""
    if part is None or field.kind == "text":
        return field.numbers
    return tuple([case.numbers[part] for case in field.cases])


def choices_in(field: Field, part: int | None) -> dict[str, int]:
    """Return the raw values of an enum by their names; empty if the numbers are not an enum."""
    if field.kind == "enum" and len(field.cases) == 1:
        return dict(zip(field.labels, field.choices))
    numbers = numbers_in(field, part)
    if len(numbers) == 1 and numbers[0].kind == "enum":
        return dict(zip(numbers[0].labels, numbers[0].choices))
    return {}


def named(numbers: Any, choices: Mapping[str, int]) -> Any:
    """Return the names of numbers as a dictionary array; ``choices`` holds every number."""
    values = pa.array([*choices.values()], numbers.type)
    index = pc.index_in(numbers, values).cast(pa.int8() if len(choices) < 128 else pa.int32())
    return pa.DictionaryArray.from_arrays(index, pa.array([*choices], pa.utf8()))


def flat(column: memoryview) -> Any:
    """Return the numbers of a buffer as an array."""
    size = column.nbytes // column.itemsize
    return pa.Array.from_buffers(TYPES[column.format], size, [None, pa.py_buffer(column)])


def _values(field: Field, part: int | None, numbers: Any) -> Any:
    """Return physical values as flags, enums, integers or floats; raw values as they are."""
    if numbers.type != pa.float64():
        return numbers
    described = numbers_in(field, part)
    if choices := choices_in(field, part):
        return named(numbers, choices)
    is_flag = field.kind == "flag" and field.const is None and len(field.cases) == 1
    if described and (is_flag or all(number.kind == "flag" for number in described)):
        return numbers.cast(pa.bool_())
    return numbers if any(number.real for number in described) else numbers.cast(pa.int64())


def _text_cells(field: Field, column: memoryview, rows: int, part: int | None) -> Any:
    count, *each = field.dimensions
    if not each:
        return _texts(field, column, rows, count)
    elements = _texts(field, column, rows * count, *each)
    if part is not None:
        return pc.list_element(_fixed(elements, count, rows), part)
    return _lists(field, elements, rows, count)


def _lists(field: Field, elements: Any, rows: int, count: int) -> Any:
    """Return rows of ``count`` elements each."""
    if field.sizes is None:
        return _fixed(elements, count, rows)
    # Variants with other numbers of elements have the same type.
    index = pa.py_buffer(_offsets(rows, count))
    offsets = pa.Array.from_buffers(pa.int32(), rows + 1, [None, index])
    return pa.ListArray.from_arrays(offsets, elements)


def _fixed(elements: Any, size: int, rows: int) -> Any:
    """Return rows of ``size`` elements each, with the size in their type."""
    type = pa.list_(elements.type, size)
    return pa.Array.from_buffers(type, rows, [None], children=[elements])


def _spans(type: Any, column: memoryview, rows: int, size: int) -> Any:
    """Return values of ``size`` bytes each on the memory of a column."""
    buffers = [None, pa.py_buffer(_offsets(rows, size)), pa.py_buffer(column)]
    return pa.Array.from_buffers(type, rows, buffers)


def _offsets(rows: int, size: int) -> array[int]:
    return array("i", range(0, rows * size + 1, size) if size else [0] * (rows + 1))


def _texts(field: Field, column: memoryview, rows: int, size: int) -> Any:
    if field.padding < 0 and field.encoding != "latin-1":
        return _spans(pa.utf8(), column, rows, size)
    data = column.tobytes()
    texts = [field.text(data[row * size : (row + 1) * size]) for row in range(rows)]
    return pa.array(texts, pa.utf8())
