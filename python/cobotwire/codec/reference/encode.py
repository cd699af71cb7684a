"""Encode values to frames; reject values that the edition does not allow.

A physical value becomes the nearest raw value (ties go to the even one): 0.29 degrees in hundredths
is 29, although ``0.29 * 100`` is a little less. All arithmetic uses IEEE doubles, so that every
codec encodes the same bytes.
"""

from __future__ import annotations

import operator
from collections.abc import Iterator, Sequence
from typing import Any

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.fields import pack_numbers
from cobotwire.protocol.number_types import is_number
from cobotwire.protocol.rejection import (
    ValueFault,
    reject_address,
    reject_value,
    reject_variant,
)
from cobotwire.protocol.table import Case, Command, Direction, Field, FrameFormat, Number, Variant

# Types that are iterable but never meant as a row of numbers.
NOT_SEQUENCES = (str, bytes, bytearray, dict, set, frozenset)


class _Rejected(Exception):
    def __init__(self, fault: ValueFault) -> None:
        self.fault = fault


def encode(
    frame: FrameFormat,
    command: Command,
    direction: Direction,
    values: Sequence[Any],
    variant: int | None,
    address: int | None,
) -> bytes:
    """Build one whole frame; see :meth:`cobotwire.codec.interface.Codec.encode`."""
    values = tuple(values)
    if address is not None and address not in frame.addresses:
        raise reject_address(address, frame.addresses)
    data = _first_that_fits(command, direction, values, variant)
    return frame.enclose(command.id, data, address, direction)


def _first_that_fits(
    command: Command, direction: Direction, values: tuple[Any, ...], variant: int | None
) -> bytes:
    rejection: UsageError | None = None
    other_size: UsageError | None = None
    for index, each in enumerate(command.variants(direction)):
        if len(each.fields) == len(values) and variant in (None, index):
            try:
                return _data(each, values)
            except UsageError as error:
                if error.argument in [f"len({f.counts or f.name})" for f in each.fields if f.sizes]:
                    # The error of the variant with the right size explains more.
                    other_size = other_size or error
                else:
                    rejection = rejection or error
    raise rejection or other_size or reject_variant(command, direction, len(values))


def _data(variant: Variant, values: tuple[Any, ...]) -> bytes:
    # Lists, not generators: a StopIteration from a value's own conversion must pass unchanged.
    return b"".join(
        [
            _field(field, _case(variant, field, values), value)
            for field, value in zip(variant.fields, values)
        ]
    )


def _case(variant: Variant, field: Field, values: Sequence[Any]) -> Case:
    if field.selector < 0:
        return field.cases[0]
    selector = variant.fields[field.selector]
    selected = _checked(selector, selector.cases[0], -1, values[field.selector])
    case = field.case(selected)
    if case is None:
        raise reject_value(selector, selector.cases[0], -1, "choice", selected)
    return case


def _field(field: Field, case: Case, value: Any) -> bytes:
    if not field.many:
        return case.numbers[0].pack(_checked(field, case, -1, value))
    if field.kind == "text" and not field.each:
        return _text(field, case, -1, len(case.numbers), value)
    if field.kind == "bytes" and isinstance(value, (bytes, bytearray, memoryview)):
        value = list(bytes(value))
    elements = _elements(field, case, -1, "type", value)
    each = field.each or 1
    if len(elements) * each != len(case.numbers):
        raise reject_value(field, case, -1, "count", elements)
    if field.kind == "text":
        return b"".join(
            [_text(field, case, index * each, each, text) for index, text in enumerate(elements)]
        )
    if field.each:
        elements = tuple([part for group in _groups(field, case, elements) for part in group])
    row = [_checked(field, case, index, element) for index, element in enumerate(elements)]
    return pack_numbers(case.numbers, row)


def _elements(
    field: Field, case: Case, element: int, fault: ValueFault, value: Any
) -> tuple[Any, ...]:
    """Return a row of values that does not change afterwards."""
    if isinstance(value, NOT_SEQUENCES):
        raise reject_value(field, case, element, fault, value)
    try:
        return tuple(value)
    except TypeError:
        raise reject_value(field, case, element, fault, value) from None


def _groups(field: Field, case: Case, groups: tuple[Any, ...]) -> Iterator[tuple[Any, ...]]:
    for index, group in enumerate(groups):
        at = index * field.each
        parts = _elements(field, case, at, "element-type", group)
        if len(parts) != field.each:
            raise reject_value(field, case, at, "element-count", parts)
        yield parts


def _text(field: Field, case: Case, element: int, size: int, value: Any) -> bytes:
    """Return the bytes of a text; ``element`` is the index of its first byte in a list of texts."""
    if not isinstance(value, str):
        raise reject_value(field, case, element, "type", value)
    try:
        data = value.encode(field.encoding)
    except UnicodeEncodeError:
        raise reject_value(field, case, element, "text", value) from None
    if len(data) > size or (len(data) < size and field.padding < 0):
        raise reject_value(field, case, element, "count", value)
    if field.padding >= 0 and data[-1:] == bytes([field.padding]):
        raise reject_value(field, case, element, "text", value)
    return data.ljust(size, bytes([max(field.padding, 0)]))


def _checked(field: Field, case: Case, element: int, value: Any) -> int:
    """Return the raw value of a legal value; ``element`` is -1 if the field has one number."""
    number = case.numbers[max(element, 0)]
    if field.counts and value is ...:
        return field.choices[0]
    try:
        raw = _real(number, value) if number.real else _integer(field, number, value)
        if not field.allows(number, raw):
            raise _Rejected("choice" if field.choices or number.choices else "range")
    except _Rejected as rejected:
        raise reject_value(field, case, element, rejected.fault, value) from None
    return raw


def _integer(field: Field, number: Number, value: Any) -> int:
    if isinstance(value, bool) and "flag" not in (field.kind, number.kind):
        raise _Rejected("type")
    try:
        return operator.index(value)
    except TypeError:
        raise _Rejected("type") from None


def _real(number: Number, value: Any) -> int:
    if not is_number(value):
        raise _Rejected("type")
    try:
        real = float(value)
    except OverflowError:
        raise _Rejected("range") from None
    except (TypeError, ValueError):
        raise _Rejected("type") from None
    if not number.scaled:
        return number.raw(real)
    steps = number.steps(real)
    # Checked before rounding, because a huge float would become a huge integer.
    if not number.minimum - 1 < steps < number.maximum + 1:
        raise _Rejected("range")
    return round(steps)
