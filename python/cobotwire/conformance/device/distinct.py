"""Values that a wrong scale, sign, width, order or place cannot leave unchanged."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, floor
from typing import Any

from cobotwire.table import Field, Number

Pair = tuple[Number, Number]
# The variant that is one step from zero.
BEYOND = 4
# Shares of the way from zero to an end: no two parts of a row are alike, nor each other's double.
SHARES = tuple(Fraction(share, 100) for share in (61, 37, 23, 83, 47, 13))


def choices_of(field: Field) -> list[Any]:
    """All numbers of a closed list; none where the list is open."""
    return list(field.choices)


def spread(rows: Sequence[Sequence[Pair]], present: Sequence[Sequence[Any]]) -> list[list[Any]]:
    """Some sets of values for fields whose parts are sent and told by pairs of numbers.

    A single value keeps to its present sign, but for one step beyond zero: a joint's lower limit is
    not set above its upper one, and a joint at zero stays at its limits.
    """
    parts = sum(len(row) for row in rows)
    keep = parts == 1 and present[0][0] != 0
    made = []
    for variant in range(5):
        values, at = [], 0
        for row, old in zip(rows, present):
            told = [
                _value(pair, variant, at + place, old[place] if keep else None)
                for place, pair in enumerate(row)
            ]
            at += len(row)
            values.append(tuple(told))
        if values not in made:
            made.append(values)
    return made


def _value(pair: Pair, variant: int, place: int, keep: float | None) -> Any:
    """A value of one part: variants 0 and 1 are in between, 2 and 3 the ends, 4 is one step."""
    step = max(_step(number) for number in pair)
    low = max(Fraction(number.minimum) * _step(number) for number in pair)
    high = min(Fraction(number.maximum) * _step(number) for number in pair)
    if keep is not None and low < 0 < high and variant == BEYOND:
        return _physical(pair[0], step if keep < 0 else -step)
    if keep is not None and low < 0 < high:
        low, high = (low, -step) if keep < 0 else (step, high)
    share = SHARES[(place + variant) % len(SHARES)]
    if low < 0 < high:
        up = (place + variant) % 2 == 0
        between = share * (high if up else low)
    else:
        between = low + share * (high - low)
    chosen = (between, between, high, low, low + step if low >= 0 else -step)[variant]
    count = min(max(round(chosen / step), ceil(low / step)), floor(high / step))
    return _physical(pair[0], count * step)


def _physical(number: Number, value: Fraction) -> Any:
    return float(value) if number.scaled else int(value)


def _step(number: Number) -> Fraction:
    return Fraction(number.multiply, number.divide)
