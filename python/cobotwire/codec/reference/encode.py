"""Encode values to frames; reject values that the edition does not allow.

A physical value becomes the nearest raw value (ties go to the even one): 0.29 degrees in hundredths
is 29, although ``0.29 * 100`` is a little less. All arithmetic uses IEEE doubles, so that every
codec encodes the same bytes.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Sequence
from typing import Any, SupportsFloat, SupportsIndex

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.rejection import ValueFault, reject_address, reject_value, reject_variant
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
    start = frame.header + _address(frame, address)
    data = _first_that_fits(command, direction, values, variant)
    body = start + bytes([frame.length(len(data)), command.id]) + data
    return body + frame.end(body)


def _address(frame: FrameFormat, address: int | None) -> bytes:
    if address is None:
        return bytes(frame.addresses[:1])
    if address not in frame.addresses:
        raise reject_address(address, frame.addresses)
    return bytes([address])


def _first_that_fits(
    command: Command, direction: Direction, values: tuple[Any, ...], variant: int | None
) -> bytes:
    rejection: UsageError | None = None
    for index, each in enumerate(command.variants(direction)):
        if len(each.fields) == len(values) and variant in (None, index):
            try:
                return _data(each, values)
            except UsageError as error:
                rejection = rejection or error
    raise rejection or reject_variant(command, direction, len(values))


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
    if isinstance(value, NOT_SEQUENCES):
        raise reject_value(field, case, -1, "type", value)
    try:
        elements = tuple(value)
    except TypeError:
        raise reject_value(field, case, -1, "type", value) from None
    if len(elements) != len(case.numbers):
        raise reject_value(field, case, -1, "count", elements)
    return b"".join(
        [
            number.pack(_checked(field, case, index, element))
            for index, (number, element) in enumerate(zip(case.numbers, elements))
        ]
    )


def _checked(field: Field, case: Case, element: int, value: Any) -> int:
    """Return the raw value of a legal value; ``element`` is -1 if the field has one number."""
    number = case.numbers[max(element, 0)]
    try:
        raw = _real(number, value) if number.real else _integer(field, value)
        if not field.allows(number, raw):
            raise _Rejected("choice" if field.choices else "range")
    except _Rejected as rejected:
        raise reject_value(field, case, element, rejected.fault, value) from None
    return raw


def _integer(field: Field, value: Any) -> int:
    if isinstance(value, bool) and field.kind != "flag":
        raise _Rejected("type")
    try:
        return operator.index(value)
    except TypeError:
        raise _Rejected("type") from None


def _real(number: Number, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, (SupportsFloat, SupportsIndex)):
        raise _Rejected("type")
    try:
        real = float(value)
    except OverflowError:
        raise _Rejected("range") from None
    except (TypeError, ValueError):
        raise _Rejected("type") from None
    if not math.isfinite(real) and not number.takes_not_finite:
        raise _Rejected("not-finite")
    if number.encoding == "float":
        return number.raw(real)
    steps = number.steps(real)
    # Checked before rounding, because a huge float would become a huge integer.
    if not number.minimum - 1 < steps < number.maximum + 1:
        raise _Rejected("range")
    return round(steps)
