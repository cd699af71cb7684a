"""Which values a run sends: boundaries, short lists in full, and values that reveal mistakes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from math import ceil, floor
from typing import Any

from cobotwire.protocol.table import Command, Field, Number, Variant

Values = tuple[Any, ...]
# A row of numbers that the arm itself reported, by the units of its parts.
Known = Mapping[tuple[str, ...], tuple[float, ...]]
# The limits of the arguments whose legal numbers are not all harmless.
Limits = Mapping[str, tuple[int, ...]]
# The number that is sent, and the number that reports it.
Pair = tuple[Number, Number]

# A range of up to this many numbers is sent in full.
SHORT = 12
# Shares of the way from zero to an end: no two parts of a row are alike, nor each other's double.
SHARES = tuple(Fraction(share, 100) for share in (61, 37, 23, 83, 47, 13))
# Samples 0 and 1 lie in between, 2 and 3 are the ends, and this one is a step beyond zero.
BEYOND = 4


def units(numbers: tuple[Number, ...]) -> tuple[str, ...]:
    """Return the units of a field's parts."""
    return tuple(number.unit for number in numbers)


def raw_samples(field: Field, number: Number) -> list[int]:
    """Return the raw values to send: all of a short list, else the ends and the middle."""
    if field.choices:
        return list(field.choices)
    low, high = number.minimum, number.maximum
    if high - low < SHORT:
        return list(range(low, high + 1))
    middle = [0, 1] if low < 0 < high else [low + 1, (low + high) // 2]
    return sorted({low, *middle, high})


def arguments(
    variant: Variant, known: Known | None = None, limits: Limits | None = None
) -> list[Values]:
    """Return arguments to request with: each field in turn takes its samples; the rest stay."""
    found: dict[Values, None] = {}
    for selected in selections(variant):
        lists = [
            [selected[at]]
            if at in selected
            else list((limits or {}).get(field.name, ()))
            or _samples(field, numbers_of(field, selected), known or {})
            for at, field in enumerate(variant.fields)
        ]
        base = [samples[0] for samples in lists]
        found[tuple(base)] = None
        for at, samples in enumerate(lists):
            for value in samples:
                found[(*base[:at], value, *base[at + 1 :])] = None
    return list(found)


def harmless(command: Command) -> list[Values]:
    """Return arguments for the shortest variant of a command, as the edition limits them."""
    return arguments(command.request[-1], limits=dict(*command.samples[-1:]))


def gentle(variant: Variant) -> Values:
    """Return the arguments that do the least: the numbers nearest to one step from zero."""
    selected = next(selections(variant))
    values: list[Any] = []
    for at, field in enumerate(variant.fields):
        row = [number.physical(number.clamp(1)) for number in numbers_of(field, selected)]
        value = tuple(row) if field.many else (field.choices[0] if field.choices else row[0])
        values.append(selected.get(at, value))
    return tuple(values)


def numbers_of(field: Field, selected: Mapping[int, int]) -> tuple[Number, ...]:
    """Return the parts of a field, by the value in ``selected`` if another field selects them."""
    case = field.case(selected.get(field.selector))
    assert case is not None, "a selection picks a case"
    return case.numbers


def selections(variant: Variant) -> Iterator[dict[int, int]]:
    """Yield every combination of values of the selectors, by their place in the variant."""
    places = sorted({field.selector for field in variant.fields} - {-1})
    lists = [
        [
            value
            for field in variant.fields
            if field.selector == at
            for case in field.cases
            for value in case.when
        ]
        for at in places
    ]
    for chosen in product(*lists):
        yield dict(zip(places, chosen))


def revealing(rows: Sequence[Sequence[Pair]], present: Sequence[Sequence[Any]]) -> list[list[Any]]:
    """Return sets of values that change under a wrong scale, sign, width, order or place.

    A single value keeps its present sign, except for one step beyond zero, so that a joint's
    lower limit stays below its upper one, and a joint at zero stays within its limits.
    """
    parts = sum(len(row) for row in rows)
    keep = parts == 1 and present[0][0] != 0
    found = []
    for sample in range(5):
        values, at = [], 0
        for row, old in zip(rows, present):
            value = [
                _revealing(pair, sample, at + place, old[place] if keep else None)
                for place, pair in enumerate(row)
            ]
            at += len(row)
            values.append(tuple(value))
        if values not in found:
            found.append(values)
    return found


def _revealing(pair: Pair, sample: int, place: int, keep: float | None) -> Any:
    step = max(number.exact(1) for number in pair)
    low = max(number.exact(number.minimum) for number in pair)
    high = min(number.exact(number.maximum) for number in pair)
    if keep is not None and low < 0 < high and sample == BEYOND:
        return _value(pair[0], step if keep < 0 else -step)
    if keep is not None and low < 0 < high:
        low, high = (low, -step) if keep < 0 else (step, high)
    share = SHARES[(place + sample) % len(SHARES)]
    if low < 0 < high:
        upwards = (place + sample) % 2 == 0
        between = share * (high if upwards else low)
    else:
        between = low + share * (high - low)
    chosen = (between, between, high, low, low + step if low >= 0 else -step)[sample]
    count = min(max(round(chosen / step), ceil(low / step)), floor(high / step))
    return _value(pair[0], count * step)


def _value(number: Number, value: Fraction) -> Any:
    return float(value) if number.scaled else int(value)


def _samples(field: Field, numbers: tuple[Number, ...], known: Known) -> list[Any]:
    if not field.many:
        return [numbers[0].physical(raw) for raw in raw_samples(field, numbers[0])]
    # The arm can calculate with a row that it reported; any other row may have no reply.
    reported = known.get(units(numbers))
    if reported is None:
        return [tuple(number.physical(number.clamp(0)) for number in numbers)]
    raw = [round(number.steps(value)) for number, value in zip(numbers, reported)]
    return [tuple(n.physical(n.clamp(value)) for n, value in zip(numbers, raw))]
