"""Columns grant and refuse views as PEP 3118 requires, for every combination of flags.

The oracle is Python's own exporter, ``memoryview``.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from itertools import product
from typing import Any

import pytest

import small_tables
from cobotwire import codec as codecs
from cobotwire.protocol.table import FrameFormat, Variant

# Every bit that a consumer can set (WRITABLE, FORMAT, ND, STRIDES, C, F, ANY and INDIRECT), and one
# bit without a meaning.
FLAGS = range(0x200)
SIMPLE, WRITABLE, FORMAT, ND = 0, 1, 4, 8
STRIDES, C_ORDER, F_ORDER, ANY_ORDER, INDIRECT = 0x18, 0x38, 0x58, 0x98, 0x118
POISON = 0xBAD


class View(ctypes.Structure):
    """C's ``Py_buffer``."""

    _fields_ = [
        ("buf", ctypes.c_void_p),
        ("obj", ctypes.c_void_p),
        ("len", ctypes.c_ssize_t),
        ("itemsize", ctypes.c_ssize_t),
        ("readonly", ctypes.c_int),
        ("ndim", ctypes.c_int),
        ("format", ctypes.c_char_p),
        ("shape", ctypes.POINTER(ctypes.c_ssize_t)),
        ("strides", ctypes.POINTER(ctypes.c_ssize_t)),
        ("suboffsets", ctypes.POINTER(ctypes.c_ssize_t)),
        ("internal", ctypes.c_void_p),
    ]


def granted(exporter: Any, flags: int) -> Any:
    """Return everything that a consumer sees of the view, or the name of the error."""
    view = View(obj=POISON)
    try:
        ctypes.pythonapi.PyObject_GetBuffer(ctypes.py_object(exporter), ctypes.byref(view), flags)
    except (BufferError, SystemError) as error:  # SystemError: 3.12 and later reject two flags
        if isinstance(error, BufferError):
            assert view.obj is None, "a refused view has no owner"
        return type(error).__name__
    try:
        assert view.obj == id(exporter)
        rows = [view.shape, view.strides, view.suboffsets]
        return (
            ctypes.string_at(view.buf or 0, view.len),
            (view.len, view.itemsize, view.readonly, view.ndim, view.format),
            [row[: view.ndim] if row else None for row in rows],
        )
    finally:
        ctypes.pythonapi.PyBuffer_Release(ctypes.byref(view))


def every_type() -> Any:
    """Return a table that has columns of every type and shape."""
    bounds = [(w, low) for w in (1, 2, 4) for low in (0, -(256**w) // 2)]
    fields = [
        small_tables.field(f"{kind}{width}_{-low}", *numbers, many=many)
        for width, low in bounds
        for kind, many, numbers in (
            ("number", False, [small_tables.number(width, low)]),
            ("one", True, [small_tables.number(width, low)]),
            ("row", True, [small_tables.number(width, low)] * 3),
        )
    ]
    sides = [small_tables.number(4), small_tables.number(1, -1)]
    fields.append(small_tables.field("wide", *sides, many=True))
    frame = FrameFormat(b"\xfe\xfe", b"\xfa", 255)
    command = small_tables.command(1, "get", (Variant(()),), (Variant(tuple(fields)),))
    return small_tables.table(command, frame=frame)


def memories() -> Iterator[tuple[str, Any]]:
    """Return columns of the native codec, with their names."""
    codec = codecs.load(every_type(), "native")
    size = codec.table.commands[0].reply[0].size
    for rows, raw in product((1, 2, 3), (False, True)):
        data = b"".join(
            bytes([0xFE, 0xFE, size + 2, 1, *[row + at % 7 for at in range(size)], 0xFA])
            for row in range(rows)
        )
        found = codec.decode_columns(data, "reply", raw=raw)
        [only] = found
        yield f"offset {rows}", only._offset
        yield f"no offsets {rows}", found._rejected
        for name, column in zip(only.names, only._columns):
            yield f"{name} {'raw' if raw else 'physical'} {rows}", column


MEMORIES = list(memories())
EACH_MEMORY = pytest.mark.parametrize("memory", [pytest.param(m, id=n) for n, m in MEMORIES])


def test_columns_have_every_type_and_shape() -> None:
    views = [memoryview(memory) for _, memory in MEMORIES]
    assert {view.format for view in views} == set("BbHhIiqQd")
    assert {(3,), (3, 1), (1, 3), (3, 3), (0,)} <= {view.shape for view in views}


@EACH_MEMORY
def test_column_grants_and_refuses_what_a_memoryview_does(memory: Any) -> None:
    same = memoryview(memory)
    copy: Any = memoryview(same.tobytes())
    copy = copy.cast(same.format, same.shape) if same.nbytes else copy.cast(same.format)
    for flags in FLAGS:
        assert granted(memory, flags) == granted(copy, flags), f"{flags:#x}"


def test_rows_of_numbers_are_bytes_without_a_shape() -> None:
    memory = dict(MEMORIES)["row2_32768 raw 3"]
    assert memoryview(memory).shape == (3, 3)
    contents, (size, _, readonly, dimensions, format), rows = granted(memory, SIMPLE)
    assert contents == memoryview(memory).tobytes()
    assert (size, readonly, dimensions, format, rows) == (18, 1, 1, None, [None] * 3)
    _, (_, itemsize, _, dimensions, format), rows = granted(memory, INDIRECT | FORMAT)
    assert (itemsize, dimensions, format, rows) == (2, 2, b"h", [[3, 3], [6, 2], None])


def test_request_that_a_column_cannot_meet_is_refused_with_its_reason() -> None:
    memory = dict(MEMORIES)["row2_32768 raw 3"]
    for flags, reason in [
        (WRITABLE | STRIDES, "a column cannot be written to"),
        (F_ORDER, "the column is in C order, not in Fortran order"),
        (FORMAT, "a view with a format needs a shape"),
    ]:
        view = View()
        with pytest.raises(BufferError, match=reason):
            ctypes.pythonapi.PyObject_GetBuffer(ctypes.py_object(memory), ctypes.byref(view), flags)
