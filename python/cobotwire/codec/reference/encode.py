"""Values to bytes. Whatever cannot be said is refused here, before anything is sent.

A physical value becomes the nearest whole number of the wire's steps (a tie goes to the even one):
0.29 degrees in hundredths is 29, although ``0.29 * 100`` is a little less. The arithmetic is IEEE
double, so that every codec gives the same bytes.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence
from typing import Any, SupportsFloat, SupportsIndex

from cobotwire.codec.reference.check import check
from cobotwire.codec.refusal import ValueFault, refuse_address, refuse_form, refuse_value
from cobotwire.errors import UsageError
from cobotwire.table import Case, Command, Direction, Field, FrameFormat, Layout, Number

# Iterable, but never meant as a row of numbers.
NOT_SEQUENCES = (str, bytes, bytearray, dict, set, frozenset)


class _Refused(Exception):
    def __init__(self, fault: ValueFault) -> None:
        self.fault = fault


def encode(
    frame: FrameFormat,
    command: Command,
    direction: Direction,
    values: Sequence[Any],
    form: int | None,
    address: int | None,
) -> bytes:
    """Build one whole frame; see :meth:`cobotwire.codec.interface.Codec.encode`."""
    values = tuple(values)
    start = frame.header + _address(frame, address)
    data = _first_that_fits(command, direction, values, form)
    body = start + bytes([frame.length(len(data)), command.id]) + data
    return body + check(frame, body)


def _address(frame: FrameFormat, address: int | None) -> bytes:
    if address is None:
        return bytes(frame.addresses[:1])
    if address not in frame.addresses:
        raise refuse_address(address, frame.addresses)
    return bytes([address])


def _first_that_fits(
    command: Command, direction: Direction, values: tuple[Any, ...], form: int | None
) -> bytes:
    refusal: UsageError | None = None
    for index, layout in enumerate(command.layouts(direction)):
        if len(layout.fields) == len(values) and form in (None, index):
            try:
                return _data(layout, values)
            except UsageError as error:
                refusal = refusal or error
    raise refusal or refuse_form(command, direction, len(values))


def _data(layout: Layout, values: tuple[Any, ...]) -> bytes:
    # Lists, not generators: an exception that a value's own conversion raises passes as it is.
    return b"".join(
        [
            _field(field, _case(layout, field, values), value)
            for field, value in zip(layout.fields, values)
        ]
    )


def _case(layout: Layout, field: Field, values: Sequence[Any]) -> Case:
    if field.selector < 0:
        return field.cases[0]
    selector = layout.fields[field.selector]
    picked = _checked(selector, selector.cases[0], -1, values[field.selector])
    for case in field.cases:
        if picked in case.when:
            return case
    raise refuse_value(selector, selector.cases[0], -1, "choice", picked)


def _field(field: Field, case: Case, value: Any) -> bytes:
    if not field.many:
        return _word(case.numbers[0], _checked(field, case, -1, value))
    if isinstance(value, NOT_SEQUENCES):
        raise refuse_value(field, case, -1, "type", value)
    try:
        elements = tuple(value)
    except TypeError:
        raise refuse_value(field, case, -1, "type", value) from None
    if len(elements) != len(case.numbers):
        raise refuse_value(field, case, -1, "count", elements)
    return b"".join(
        [
            _word(number, _checked(field, case, index, element))
            for index, (number, element) in enumerate(zip(case.numbers, elements))
        ]
    )


def _word(number: Number, whole: int) -> bytes:
    word = whole % (1 << 8 * number.width)
    return word.to_bytes(number.width, number.order)


def _checked(field: Field, case: Case, element: int, value: Any) -> int:
    """The whole number on the wire for one value; the element is -1 where there is only one."""
    number = case.numbers[max(element, 0)]
    try:
        whole = _scaled(number, value) if number.scaled else _integer(field, value)
        if field.choices:
            if whole not in field.choices:
                raise _Refused("choice")
        elif not number.minimum <= whole <= number.maximum:
            raise _Refused("range")
    except _Refused as refused:
        raise refuse_value(field, case, element, refused.fault, value) from None
    return whole


def _integer(field: Field, value: Any) -> int:
    if isinstance(value, bool) and field.kind != "flag":
        raise _Refused("type")
    try:
        return operator.index(value)
    except TypeError:
        raise _Refused("type") from None


def _scaled(number: Number, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, (SupportsFloat, SupportsIndex)):
        raise _Refused("type")
    try:
        real = float(value)
    except OverflowError:
        raise _Refused("range") from None
    except (TypeError, ValueError):
        raise _Refused("type") from None
    if not math.isfinite(real):
        raise _Refused("not-finite")
    steps = real * number.divide / number.multiply
    # Before rounding: a step count beyond the bounds by one or more has no whole number to be.
    if not number.minimum - 1 < steps < number.maximum + 1:
        raise _Refused("range")
    return round(steps)
