"""Samples of messages: ordinary raw values for the fields, and each of their corner values.

A sample holds a raw value for every number of a variant. In an ordinary sample all of them differ,
as far as the ranges allow, so that a wrong order, sign or scale shows.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite
from typing import Any, NamedTuple

from cobotwire.conformance.places import Place, is_list, numbers_of, picks, places
from cobotwire.protocol.table import Field, Number, Variant

RawValues = tuple[tuple[int, ...], ...]

# Steps from the bottom of a range; odd, so that bytes and decimal places of neighbours differ.
_STRIDE = 0x0125


class Sample(NamedTuple):
    """Raw values by field and element; ``name`` says what is special about them."""

    name: str
    raw_values: RawValues


def ordinary(variant: Variant, picked: dict[int, int] | None = None, turn: int = 0) -> RawValues:
    """Return ordinary raw values, with those of ``picked`` in the fields at its indices."""
    raw_values: list[tuple[int, ...]] = [()] * len(variant.fields)
    count = turn
    for index in sorted(range(len(variant.fields)), key=lambda i: variant.fields[i].selector >= 0):
        field = variant.fields[index]
        if picked and index in picked:
            raw_values[index] = (picked[index],)
            continue
        case = variant.raw_case(field, tuple(raw_values))
        assert case is not None, "an ordinary selector has a case"
        row = []
        for number in case.numbers:
            count += 1
            row.append(_ordinary(field, number, count))
        raw_values[index] = tuple(row)
    return tuple(raw_values)


def _ordinary(field: Field, number: Number, count: int) -> int:
    choices = field.choices or number.choices
    if choices:
        return choices[count % len(choices)]
    if field.kind == "text":
        # Letters are legal in every encoding, and no text is padded with them.
        return ord("a") + count % 26
    span = number.maximum - number.minimum + 1
    middle = number.minimum + span // 3
    return number.minimum + (middle - number.minimum + count * _STRIDE) % span


def plainest(variant: Variant, near: int = 0) -> RawValues:
    """Return the legal raw values nearest to ``near``; of a closed list, the first."""
    picked = next(picks(variant))
    return tuple(
        (picked[index],)
        if index in picked
        else tuple(
            next(iter(field.choices or number.choices), number.clamp(near))
            for number in numbers_of(field, picked)
        )
        for index, field in enumerate(variant.fields)
    )


def samples(variant: Variant) -> Iterator[Sample]:
    """Yield a sample for every case of every selector, and for every corner value in it."""
    seen: set[RawValues] = set()
    for picked in picks(variant):
        name, base = _prefix(variant, picked), ordinary(variant, picked)
        found = [
            Sample(f"{name}ordinary", base),
            Sample(f"{name}ordinary-again", ordinary(variant, picked, turn=7)),
            Sample(f"{name}defaults", _with_defaults(variant, base)),
        ]
        for place in _corners(variant, picked):
            if place.index not in picked:
                found += [_with(base, place, raw, name) for raw in legal(place.field, place.number)]
        for sample in found:
            if sample.raw_values not in seen:
                seen.add(sample.raw_values)
                yield sample


def illegal_samples(variant: Variant) -> Iterator[Sample]:
    """Yield ordinary samples with one raw value that fits the wire but is illegal in its field."""
    for picked in picks(variant):
        name, base = _prefix(variant, picked), ordinary(variant, picked)
        for place in _corners(variant, picked):
            for raw in beyond(place.field, place.number):
                yield _with(base, place, raw, name)


def _corners(variant: Variant, picked: Mapping[int, int]) -> Iterator[Place]:
    """Yield the numbers that take corner values.

    Of bytes, texts and groups these are the first and the last element, and of a size that varies
    the least and the most elements: the others are read in the same way.
    """
    for place in places(variant, picked):
        field, [count, *_] = place.field, place.field.dimensions or (1,)
        each = field.each or 1
        if field.sizes and not field.counts and count not in field.sizes:
            continue
        if not is_list(field) or not each <= place.element < (count - 1) * each:
            yield place


def _with_defaults(variant: Variant, base: RawValues) -> RawValues:
    """Return the raw values of a call that leaves out every argument with a default."""
    return tuple(
        row if field.default is None else field.default for field, row in zip(variant.fields, base)
    )


def _with(base: RawValues, place: Place, raw: int, prefix: str) -> Sample:
    return Sample(f"{prefix}{place.name}={raw}", with_one(base, place.index, place.element, raw))


def _prefix(variant: Variant, picked: Mapping[int, int]) -> str:
    return "".join(f"{variant.fields[index].name}={raw}-" for index, raw in picked.items())


def with_row(raw_values: RawValues, index: int, row: tuple[int, ...]) -> RawValues:
    """Return the raw values with the row of one field replaced."""
    return (*raw_values[:index], row, *raw_values[index + 1 :])


def with_one(raw_values: RawValues, index: int, element: int, raw: int) -> RawValues:
    """Return the raw values with one of them replaced."""
    row = raw_values[index]
    return with_row(raw_values, index, (*row[:element], raw, *row[element + 1 :]))


def legal(field: Field, number: Number) -> list[int]:
    """Return legal corner values: ends, zero and its neighbours, the numbers at the sign change."""
    if field.choices or number.choices:
        return list(field.choices or number.choices)
    top = 256**number.width
    low, high = number.minimum, number.maximum
    turn = (number.signed_at, number.signed_at - 1, number.signed_at + 1 - top)
    wished = {low, low + 1, high - 1, high, -1, 0, 1, 2, 127, 128, 255, 256, -256, *turn}
    return sorted(raw for raw in wished if low <= raw <= high)


def beyond(field: Field, number: Number) -> list[int]:
    """Return the values next to the legal ones, and the ends of what the wire can carry."""
    lowest, highest = number.raw_range
    choices = field.choices or number.choices
    if choices:
        near = {c + step for c in choices for step in (-1, 1)}
        wished = {*near, lowest, highest} - set(choices)
    else:
        wished = {number.minimum - 1, number.maximum + 1, lowest, highest}
        wished = {raw for raw in wished if not number.minimum <= raw <= number.maximum}
    return sorted(raw for raw in wished if lowest <= raw <= highest)


def named_values(variant: Variant, raw_values: RawValues) -> dict[str, Any]:
    """Return the physical values by field name, as JSON values.

    Raises:
        UnicodeDecodeError: the bytes of a text are no text.
    """
    values = physical_values(variant, raw_values)
    return {name: plain(value) for name, value in values.items()}


def physical_values(variant: Variant, raw_values: RawValues) -> dict[str, Any]:
    """Return the physical values by field name, as messages take them.

    Raises:
        UnicodeDecodeError: the bytes of a text are no text.
    """
    given: dict[str, Any] = {}
    for field, row in zip(variant.fields, raw_values):
        case = variant.raw_case(field, raw_values) or field.cases[0]
        values = [number.physical(raw) for number, raw in zip(case.numbers, row)]
        given[field.name] = field.present(values)
    return given


def plain(value: Any) -> Any:
    """Return a value as a JSON value, as ``docs/codec-protocol.md`` describes them."""
    if isinstance(value, tuple | list):
        return [plain(part) for part in value]
    if isinstance(value, bytes):
        return value.hex().upper()
    if isinstance(value, float):
        return value if isfinite(value) else str(value)
    return value if isinstance(value, str) else int(value)
