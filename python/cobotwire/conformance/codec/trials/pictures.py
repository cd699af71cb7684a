"""Whole numbers for the fields of a message: ordinary ones, and each of their corners.

A picture holds a whole number for every number of a layout. It is ordinary when no two of them are
alike, as far as the ranges allow: then an exchanged order, sign or scale shows.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from cobotwire.codec.refusal import physical
from cobotwire.table import Case, Field, Layout, Number

Wholes = tuple[tuple[int, ...], ...]

# Steps from the bottom of a range; odd, so that bytes and decimal places of neighbours differ.
_STRIDE = 0x0125


class Picture(NamedTuple):
    """Whole numbers by field and element; ``name`` says what is special about them."""

    name: str
    wholes: Wholes


def case_of(layout: Layout, field: Field, wholes: Wholes) -> Case | None:
    """How a field reads in a picture; None: its selector holds what no case knows."""
    if field.selector < 0:
        return field.cases[0]
    picked = wholes[field.selector][0]
    return next((case for case in field.cases if picked in case.when), None)


def ordinary(layout: Layout, picked: dict[int, int] | None = None, turn: int = 0) -> Wholes:
    """An ordinary picture, in which the field at each index of ``picked`` holds that number."""
    wholes: list[tuple[int, ...]] = [()] * len(layout.fields)
    count = turn
    for index in sorted(range(len(layout.fields)), key=lambda i: layout.fields[i].selector >= 0):
        field = layout.fields[index]
        if picked and index in picked:
            wholes[index] = (picked[index],)
            continue
        case = case_of(layout, field, tuple(wholes))
        assert case is not None, "an ordinary selector has a case"
        row = []
        for number in case.numbers:
            count += 1
            row.append(_ordinary(field, number, count))
        wholes[index] = tuple(row)
    return tuple(wholes)


def _ordinary(field: Field, number: Number, count: int) -> int:
    if field.choices:
        return field.choices[count % len(field.choices)]
    span = number.maximum - number.minimum + 1
    middle = number.minimum + span // 3
    return number.minimum + (middle - number.minimum + count * _STRIDE) % span


def plainest(layout: Layout) -> Wholes:
    """Zeros, or what is nearest to them: what every implementation takes."""
    return tuple(
        tuple(_near_zero(field, number) for number in field.cases[0].numbers)
        for field in layout.fields
    )


def _near_zero(field: Field, number: Number) -> int:
    return field.choices[0] if field.choices else min(max(0, number.minimum), number.maximum)


def pictures(layout: Layout) -> Iterator[Picture]:
    """All that is worth telling apart: every case of every selector, and every corner in it."""
    seen: set[Wholes] = set()
    for name, picked in _picks(layout):
        for picture in _corners(layout, name, picked):
            if picture.wholes not in seen:
                seen.add(picture.wholes)
                yield picture


def _picks(layout: Layout) -> Iterator[tuple[str, dict[int, int]]]:
    """What the selectors may hold; one at a time, since no message has two that interact."""
    selectors = sorted({field.selector for field in layout.fields if field.selector >= 0})
    if not selectors:
        yield "", {}
    for index in selectors:
        field = layout.fields[index]
        for whole in _all_of(field):
            if any(whole in case.when for f in layout.fields for case in f.cases):
                yield f"{field.name}={whole}-", {index: whole}


def _all_of(field: Field) -> tuple[int, ...]:
    number = field.cases[0].numbers[0]
    return field.choices or tuple(range(number.minimum, number.maximum + 1))


def _corners(layout: Layout, name: str, picked: dict[int, int]) -> Iterator[Picture]:
    base = ordinary(layout, picked)
    yield Picture(f"{name}ordinary", base)
    yield Picture(f"{name}ordinary-again", ordinary(layout, picked, turn=7))
    for index, field in enumerate(layout.fields):
        case = case_of(layout, field, base)
        assert case is not None, "an ordinary selector has a case"
        for element, number in enumerate(case.numbers):
            for whole in legal(field, number) if index not in picked else ():
                place = _place(field, number, element)
                yield Picture(f"{name}{place}={whole}", with_one(base, index, element, whole))


def illegal_pictures(layout: Layout) -> Iterator[tuple[Picture, int, int]]:
    """An ordinary picture with one number that the field does not allow, and the wire can carry.

    Behind it stand the index of the field and of the element.
    """
    for name, picked in _picks(layout):
        base = ordinary(layout, picked)
        for index, field in enumerate(layout.fields):
            case = case_of(layout, field, base)
            assert case is not None, "an ordinary selector has a case"
            for element, number in enumerate(case.numbers):
                for whole in beyond(field, number):
                    place = _place(field, number, element)
                    wrong = with_one(base, index, element, whole)
                    yield Picture(f"{name}{place}={whole}", wrong), index, element


def with_one(wholes: Wholes, index: int, element: int, whole: int) -> Wholes:
    """The same picture with another number in one place."""
    row = (*wholes[index][:element], whole, *wholes[index][element + 1 :])
    return (*wholes[:index], row, *wholes[index + 1 :])


def legal(field: Field, number: Number) -> list[int]:
    """The corners of what is allowed: ends, zero and its neighbours, and where the sign turns."""
    if field.choices:
        return list(field.choices)
    top = 256**number.width
    low, high = number.minimum, number.maximum
    turn = (number.signed_at, number.signed_at - 1, number.signed_at + 1 - top)
    wished = {low, low + 1, high - 1, high, -1, 0, 1, 2, 127, 128, 255, 256, -256, *turn}
    return sorted(whole for whole in wished if low <= whole <= high)


def beyond(field: Field, number: Number) -> list[int]:
    """What is next to the allowed, and the ends of what the wire can carry."""
    top = 256**number.width
    lowest, highest = (
        (number.signed_at + 1 - top if number.signed_at < top - 1 else 0),
        (number.signed_at),
    )
    if field.choices:
        near = {c + step for c in field.choices for step in (-1, 1)} - set(field.choices)
        wished = {*near, lowest, highest} - set(field.choices)
    else:
        wished = {number.minimum - 1, number.maximum + 1, lowest, highest}
        wished -= set(range(number.minimum, number.maximum + 1))
    return sorted(whole for whole in wished if lowest <= whole <= highest)


def wire_data(layout: Layout, wholes: Wholes) -> bytes:
    """The data bytes of a picture, whether or not it is allowed."""
    data = b""
    for field, row in zip(layout.fields, wholes):
        case = case_of(layout, field, wholes) or field.cases[0]
        for number, whole in zip(case.numbers, row):
            data += (whole % 256**number.width).to_bytes(number.width, number.order)
    return data


def named_values(layout: Layout, wholes: Wholes) -> dict[str, Any]:
    """The physical values by field name, as JSON has them."""
    given: dict[str, Any] = {}
    for field, row in zip(layout.fields, wholes):
        case = case_of(layout, field, wholes) or field.cases[0]
        values = [physical(number, whole) for number, whole in zip(case.numbers, row)]
        given[field.name] = values if field.many else values[0]
    return given


def _place(field: Field, number: Number, element: int) -> str:
    return f"{field.name}.{number.name or element}" if field.many else field.name
