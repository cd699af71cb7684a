"""Derive raw values: for a single number of a field, and for every number of a variant.

In an ordinary sample all of them differ, as far as the ranges allow, so that a wrong order, sign or
scale shows.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count
from typing import NamedTuple

from cobotwire.conformance.located import LocatedNumber, is_list, located_numbers, numbers_of, picks
from cobotwire.protocol.table import Field, Number, Variant

# The raw values of a variant, by field and element.
RawValues = tuple[tuple[int, ...], ...]
# The rows of numbers that the arm itself reported, by the units of their numbers. A row is empty if
# its query has no reply; then the arm cannot calculate with a row of these units.
Known = Mapping[tuple[str, ...], tuple[float, ...]]
# The raw values by argument that a run may send, where not all legal ones are harmless.
Limits = Mapping[str, tuple[int, ...]]

# Steps from the bottom of a range; odd, so that bytes and decimal places of neighbours differ.
_STRIDE = 0x0125
# A range of up to this many numbers is harmless in full.
_SHORT = 12


def listed(field: Field, number: Number) -> tuple[int, ...]:
    """Return the closed list of a number; empty: it has a range."""
    return field.choices or number.choices


def ordinary_number(field: Field, number: Number, count: int) -> int:
    """Return an ordinary raw value, which differs between ``count`` and ``count + 1``."""
    if choices := listed(field, number):
        return choices[count % len(choices)]
    if field.kind == "text":
        # Letters are legal in every encoding, and no text is padded with them.
        return ord("a") + count % 26
    span = number.maximum - number.minimum + 1
    return number.minimum + (span // 3 + count * _STRIDE) % span


def nearest(field: Field, number: Number, raw: int) -> int:
    """Return the legal raw value nearest to ``raw``, or the first of a closed list."""
    return next(iter(listed(field, number)), number.clamp(raw))


def corners(field: Field, number: Number) -> list[int]:
    """Return legal corner values: ends, zero and its neighbours, the numbers at the sign change."""
    if choices := listed(field, number):
        return list(choices)
    top = 256**number.width
    low, high = number.minimum, number.maximum
    turn = (number.signed_at, number.signed_at - 1, number.signed_at + 1 - top)
    wished = {low, low + 1, high - 1, high, -1, 0, 1, 2, 127, 128, 255, 256, -256, *turn}
    return sorted(raw for raw in wished if low <= raw <= high)


def beyond(field: Field, number: Number) -> list[int]:
    """Return the illegal values next to legal ones, and the illegal ends of the wire's range."""
    lowest, highest = number.raw_range
    choices = listed(field, number)
    if choices:
        near = {c + step for c in choices for step in (-1, 1)}
        wished = {*near, lowest, highest} - set(choices)
    else:
        wished = {number.minimum - 1, number.maximum + 1, lowest, highest}
        wished = {raw for raw in wished if not number.minimum <= raw <= number.maximum}
    return sorted(raw for raw in wished if lowest <= raw <= highest)


def few(field: Field, number: Number) -> list[int]:
    """Return all of a short list or range, else the ends and the middle."""
    if choices := listed(field, number):
        return list(choices)
    low, high = number.minimum, number.maximum
    if high - low < _SHORT:
        return list(range(low, high + 1))
    middle = [0, 1] if low < 0 < high else [low + 1, (low + high) // 2]
    return sorted({low, *middle, high})


class Sample(NamedTuple):
    """Raw values; ``name`` says what is special about them."""

    name: str
    raw_values: RawValues


def ordinary(variant: Variant, picked: dict[int, int] | None = None, turn: int = 0) -> RawValues:
    """Return ordinary raw values, with those of ``picked`` in the fields at its indices."""
    raw_values: list[tuple[int, ...]] = [()] * len(variant.fields)
    counter = count(turn + 1)
    for index in sorted(range(len(variant.fields)), key=lambda i: variant.fields[i].selector >= 0):
        field = variant.fields[index]
        if picked and index in picked:
            raw_values[index] = (picked[index],)
            continue
        case = variant.raw_case(field, tuple(raw_values))
        assert case is not None, "an ordinary selector has a case"
        row = (ordinary_number(field, number, next(counter)) for number in case.numbers)
        raw_values[index] = tuple(row)
    return tuple(raw_values)


def plainest(variant: Variant, near: int = 0) -> RawValues:
    """Return the legal raw value of each number nearest to ``near``, or the first of its list."""
    picked = next(picks(variant))
    return tuple(
        (picked[index],)
        if index in picked
        else tuple(nearest(field, number, near) for number in numbers_of(field, picked))
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
        for located in _varied(variant, picked):
            if located.index not in picked:
                found += [
                    _with(base, located, raw, name)
                    for raw in corners(located.field, located.number)
                ]
        for sample in found:
            if sample.raw_values not in seen:
                seen.add(sample.raw_values)
                yield sample


def illegal_samples(variant: Variant) -> Iterator[Sample]:
    """Yield ordinary samples with one raw value that fits the wire but is illegal in its field."""
    for picked in picks(variant):
        name, base = _prefix(variant, picked), ordinary(variant, picked)
        for located in _varied(variant, picked):
            for raw in beyond(located.field, located.number):
                yield _with(base, located, raw, name)


def harmless_values(variant: Variant, known: Known, limits: Limits) -> list[RawValues]:
    """Return values that a device may be sent: a few for each field in turn, while the rest stay.

    Values with a row that the arm cannot report are left out.
    """
    found: dict[RawValues, None] = {}
    for picked in picks(variant):
        if any(
            raw not in limits.get(variant.fields[at].name, (raw,)) for at, raw in picked.items()
        ) or not all(_has_row(known, field, picked) for field in variant.fields):
            continue
        lists = [
            [(picked[index],)]
            if index in picked
            else [(raw,) for raw in limits.get(field.name, ())]
            or _few_rows(field, numbers_of(field, picked), known)
            for index, field in enumerate(variant.fields)
        ]
        base = tuple(rows[0] for rows in lists)
        varied = (with_row(base, at, row) for at, rows in enumerate(lists) for row in rows)
        found |= dict.fromkeys((base, *varied))
    return list(found)


def units(numbers: tuple[Number, ...]) -> tuple[str, ...]:
    """Return the units of a field's numbers."""
    return tuple(number.unit for number in numbers)


def _has_row(known: Known, field: Field, picked: Mapping[int, int]) -> bool:
    return not field.many or known.get(units(numbers_of(field, picked))) != ()


def _few_rows(field: Field, numbers: tuple[Number, ...], known: Known) -> list[tuple[int, ...]]:
    if not field.many:
        return [(raw,) for raw in few(field, numbers[0])]
    # The arm can calculate with a row that it reported; any other row may have no reply.
    reported = known.get(units(numbers), (0.0,) * len(numbers))
    raw = [round(number.steps(value)) for number, value in zip(numbers, reported)]
    return [tuple(v if v in n.choices else nearest(field, n, v) for n, v in zip(numbers, raw))]


def _varied(variant: Variant, picked: Mapping[int, int]) -> Iterator[LocatedNumber]:
    """Yield the numbers that take corner values.

    For bytes, texts and groups these are the first and the last element; for a varying size, the
    smallest and the largest size. The others are read in the same way.
    """
    for located in located_numbers(variant, picked):
        field, [size, *_] = located.field, located.field.dimensions or (1,)
        each = field.each or 1
        if field.sizes and not field.counts and size not in field.sizes:
            continue
        if not is_list(field) or not each <= located.element < (size - 1) * each:
            yield located


def _with_defaults(variant: Variant, base: RawValues) -> RawValues:
    """Return the raw values of a call that leaves out every argument with a default."""
    return tuple(
        row if field.default is None else field.default for field, row in zip(variant.fields, base)
    )


def _with(base: RawValues, located: LocatedNumber, raw: int, prefix: str) -> Sample:
    return Sample(
        f"{prefix}{located.name}={raw}", with_one(base, located.index, located.element, raw)
    )


def _prefix(variant: Variant, picked: Mapping[int, int]) -> str:
    return "".join(f"{variant.fields[index].name}={raw}-" for index, raw in picked.items())


def with_row(raw_values: RawValues, index: int, row: tuple[int, ...]) -> RawValues:
    """Return the raw values with the row of one field replaced."""
    return (*raw_values[:index], row, *raw_values[index + 1 :])


def with_one(raw_values: RawValues, index: int, element: int, raw: int) -> RawValues:
    """Return the raw values with one of them replaced."""
    row = raw_values[index]
    return with_row(raw_values, index, (*row[:element], raw, *row[element + 1 :]))
