"""Bytes to values. An illegal frame, or a value that the edition rules out, is an error."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.codec.events import Message
from cobotwire.codec.reference.check import check
from cobotwire.codec.reference.legal import Form, Forms
from cobotwire.codec.refusal import physical, refuse_frame, refuse_raw
from cobotwire.errors import ProtocolError
from cobotwire.table import Case, Command, Direction, Field, FrameFormat, Layout, Number


def decode(forms: Forms, direction: Direction, data: bytes, of: Command | None) -> Message:
    """Read one whole frame; see :meth:`cobotwire.codec.interface.Codec.decode`."""
    data = bytes(data)
    refusal: ProtocolError | None = None
    for command, layout in _forms(forms, direction, data, of):
        try:
            values = _values(forms, command, layout, data)
        except ProtocolError as error:
            refusal = refusal or error
            continue
        frame = forms.table.frame
        address = data[frame.length_at - 1] if frame.addresses else None
        return Message(command, direction, layout, values, address)
    assert refusal is not None, "a legal frame has a form"
    raise refusal


def read(forms: Sequence[Forms], data: bytes) -> Message:
    """Read a frame that a framer gave: in the first direction that allows its values."""
    table = forms[0].table
    length, id = data[table.frame.length_at], data[table.frame.overhead]
    refusal: ProtocolError | None = None
    for each in forms:
        if each.find(id, length):
            try:
                return decode(each, each.direction, data, None)
            except ProtocolError as error:
                refusal = refusal or error
    at = table.frame.overhead
    raise refusal or refuse_frame(table, forms[0].direction, "unknown-id", at, data)


def _forms(forms: Forms, direction: Direction, data: bytes, of: Command | None) -> list[Form]:
    """The forms that a whole, legal frame can have."""
    table = forms.table
    frame = table.frame
    at = frame.length_at
    for index, byte in enumerate(frame.header):
        if index == len(data):
            raise refuse_frame(table, direction, "truncated", index, data)
        if data[index] != byte:
            raise refuse_frame(table, direction, "no-header", index, data)
    if frame.addresses and len(data) >= at and data[at - 1] not in frame.addresses:
        raise refuse_frame(table, direction, "bad-address", at - 1, data)
    if len(data) < frame.overhead:
        raise refuse_frame(table, direction, "truncated", len(data), data)
    if data[at] not in forms.lengths:
        raise refuse_frame(table, direction, "bad-length", at, data)
    if len(data) < frame.overhead + 1:
        raise refuse_frame(table, direction, "truncated", len(data), data)
    found = _named(forms, direction, data, of)
    end = frame.overhead + data[at]
    if len(data) < end:
        raise refuse_frame(table, direction, "truncated", len(data), data)
    last = end - frame.check_size
    if data[last:end] != check(frame, data[:last]):
        raise refuse_frame(table, direction, "bad-check", last, data)
    if len(data) > end:
        raise refuse_frame(table, direction, "trailing", end, data)
    return found


def _named(forms: Forms, direction: Direction, data: bytes, of: Command | None) -> list[Form]:
    """The forms with the frame's id and LEN; those of one command, where it is named."""
    at = forms.table.frame.length_at
    id = data[at + 1]
    found = [form for form in forms.find(id, data[at]) if of is None or form[0] is of]
    if found:
        return found
    if id in forms.by_id if of is None else id == of.id:
        raise refuse_frame(forms.table, direction, "bad-length", at, data)
    raise refuse_frame(forms.table, direction, "unknown-id", at + 1, data)


def _values(forms: Forms, command: Command, layout: Layout, data: bytes) -> tuple[object, ...]:
    values: list[object] = []
    offset = forms.table.frame.overhead + 1
    for field in layout.fields:
        case = _case(forms, command, layout, field, data)
        parts = _numbers(command, field, case, offset, data)
        values.append(parts if field.many else parts[0])
        offset += field.size
    return tuple(values)


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


def whole_numbers(frame: FrameFormat, layout: Layout, data: bytes) -> list[tuple[int, ...]]:
    """Each field's numbers of a frame that was decoded as this form, before their scale."""
    found, offset = [], frame.overhead + 1
    for field in layout.fields:
        numbers = []
        # All cases take the same bytes; which one it is decides how they are cut.
        for number in picked_case(frame, layout, field, data).numbers:
            numbers.append(whole(number, data, offset))
            offset += number.width
        found.append(tuple(numbers))
    return found


def picked_case(frame: FrameFormat, layout: Layout, field: Field, data: bytes) -> Case:
    """The case that a field's selector picks in a frame that was decoded."""
    if field.selector < 0:
        return field.cases[0]
    before = sum(other.size for other in layout.fields[: field.selector])
    number = layout.fields[field.selector].cases[0].numbers[0]
    picked = whole(number, data, frame.overhead + 1 + before)
    return next(case for case in field.cases if picked in case.when)


def whole(number: Number, data: bytes, offset: int) -> int:
    """The whole number that stands at ``offset``, after the sign rule."""
    word = int.from_bytes(data[offset : offset + number.width], number.order)
    return word - 256**number.width if word > number.signed_at else word
