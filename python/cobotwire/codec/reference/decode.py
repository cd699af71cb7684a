"""Bytes to values. An illegal frame, or a value that the edition rules out, is an error."""

from __future__ import annotations

from cobotwire.codec.interface import Message
from cobotwire.codec.reference.legal import Forms
from cobotwire.codec.refusal import physical, refuse_frame, refuse_raw
from cobotwire.table import Case, Command, Direction, Field, Layout, Number


def decode(forms: Forms, direction: Direction, data: bytes) -> Message:
    """Read one whole frame; see :meth:`cobotwire.codec.interface.Codec.decode`."""
    data = bytes(data)
    command, layout = _form(forms, direction, data)
    values: list[object] = []
    offset = forms.table.frame.overhead + 1
    for field in layout.fields:
        case = _case(forms, command, layout, field, data)
        parts = _numbers(command, field, case, offset, data)
        values.append(parts if field.many else parts[0])
        offset += field.size
    return Message(command, direction, layout, tuple(values))


def _form(forms: Forms, direction: Direction, data: bytes) -> tuple[Command, Layout]:
    table = forms.table
    frame = table.frame
    for index, byte in enumerate(frame.header):
        if index == len(data):
            raise refuse_frame(table, direction, "truncated", index, data)
        if data[index] != byte:
            raise refuse_frame(table, direction, "no-header", index, data)
    if len(data) < frame.overhead:
        raise refuse_frame(table, direction, "truncated", len(data), data)
    if data[2] not in forms.lengths:
        raise refuse_frame(table, direction, "bad-length", 2, data)
    if len(data) < frame.overhead + 1:
        raise refuse_frame(table, direction, "truncated", len(data), data)
    form = forms.find(data[3], data[2])
    if form is None:
        if data[3] in forms.by_id:
            raise refuse_frame(table, direction, "bad-length", 2, data)
        raise refuse_frame(table, direction, "unknown-id", 3, data)
    end = frame.overhead + data[2]
    if len(data) < end:
        raise refuse_frame(table, direction, "truncated", len(data), data)
    if not data[:end].endswith(frame.footer):
        raise refuse_frame(table, direction, "bad-footer", end - len(frame.footer), data)
    if len(data) > end:
        raise refuse_frame(table, direction, "trailing", end, data)
    return form


def _case(forms: Forms, command: Command, layout: Layout, field: Field, data: bytes) -> Case:
    if field.selector < 0:
        return field.cases[0]
    selector = layout.fields[field.selector]
    before = sum(other.size for other in layout.fields[: field.selector])
    offset = forms.table.frame.overhead + 1 + before
    picked = whole(selector.cases[0].numbers[0], data, offset)
    for case in field.cases:
        if picked in case.when:
            return case
    raise refuse_raw(command, selector, selector.cases[0], 0, picked, offset, data)


def _numbers(
    command: Command, field: Field, case: Case, offset: int, data: bytes
) -> tuple[int | float, ...]:
    values: list[int | float] = []
    for index, number in enumerate(case.numbers):
        read = whole(number, data, offset)
        legal = number.minimum <= read <= number.maximum
        if field.choices:
            legal = read in field.choices
        if not legal:
            raise refuse_raw(command, field, case, index, read, offset, data)
        values.append(physical(number, read))
        offset += number.width
    return tuple(values)


def whole(number: Number, data: bytes, offset: int) -> int:
    """The whole number that stands at ``offset``, after the sign rule."""
    word = int.from_bytes(data[offset : offset + number.width], number.order)
    return word - 256**number.width if word > number.signed_at else word
