"""Derive the physical values of samples, and physical values that no raw value expresses."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from math import ceil, floor, isfinite
from typing import Any

from cobotwire.conformance.located import is_list
from cobotwire.conformance.samples.raw import RawValues, ordinary
from cobotwire.protocol.table import Field, Number, Variant

# The number that is sent, and the number that reports it.
Numbers = tuple[Number, Number]

# Texts that differ at every position, made of characters that a name may have.
_TEXTS = (("cobot 1", "pass-word 2"), ("A", "B8"))
# The turns of the ordinary values that bytes, texts and lists are set to, one after the other.
_TURNS = (0, 7)
# Fractions of the distance from zero to an end. All differ, and none is the double of another, so
# that each number of a row is recognised.
_SHARES = tuple(Fraction(share, 100) for share in (61, 37, 23, 83, 47, 13))
# Samples 0 and 1 lie between zero and an end, 2 and 3 are the ends; this one is a step beyond zero.
_BEYOND = 4


def physical_values(variant: Variant, raw_values: RawValues) -> dict[str, Any]:
    """Return the physical values by field name, as messages take them.

    Raises:
        UnicodeDecodeError: the bytes of a text are not legal.
    """
    found: dict[str, Any] = {}
    for field, row in zip(variant.fields, raw_values):
        case = variant.raw_case(field, raw_values) or field.cases[0]
        values = [number.physical(raw) for number, raw in zip(case.numbers, row)]
        found[field.name] = field.present(values)
    return found


def arguments(variant: Variant, raw_values: RawValues) -> dict[str, Any]:
    """Return the values of a request by name; messages compute the counts of lists."""
    counts = {field.name: ... for field in variant.fields if field.counts}
    return physical_values(variant, raw_values) | counts


def named_values(variant: Variant, raw_values: RawValues) -> dict[str, Any]:
    """Return the physical values by field name, as JSON values.

    Raises:
        UnicodeDecodeError: the bytes of a text are not legal.
    """
    values = physical_values(variant, raw_values)
    return {name: plain(value) for name, value in values.items()}


def plain(value: Any) -> Any:
    """Return a value as a JSON value, as ``docs/codec-protocol.md`` describes them."""
    if isinstance(value, tuple | list):
        return [plain(part) for part in value]
    if isinstance(value, bytes):
        return value.hex().upper()
    if isinstance(value, float):
        return value if isfinite(value) else str(value)
    return value if isinstance(value, str) else int(value)


def between_steps(variant: Variant) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield values to be rounded: to the nearest step, ties to the even one, within the bounds."""
    base = ordinary(variant)
    values = named_values(variant, base)
    for field in variant.fields:
        case = variant.raw_case(field, base)
        assert case is not None, "an ordinary selector has a case"
        number = next(iter(case.numbers), None)
        if number is None or not number.scaled or field.choices or field.each:
            continue
        for steps in _fractions(number):
            value: Any = steps * number.multiply / number.divide
            if field.many:
                value = [value, *values[field.name][1:]]
            yield f"{field.name}={steps}-steps", {**values, field.name: value}


def _fractions(number: Number) -> list[float]:
    low, high = number.minimum, number.maximum
    wished = [0.4, 0.6, -0.4, -0.6, 1.5, 2.5, -1.5, -2.5, 28.999999999999996, 100.3]
    return [steps for steps in wished if low <= steps <= high] + [high + 0.4, low - 0.4]


def wrong_counts(variant: Variant) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield values with a list that has one element too few, or one too many."""
    values = named_values(variant, ordinary(variant))
    for field in variant.fields:
        row = values[field.name]
        if not field.many or not row:
            continue
        # A byte has two digits.
        size = 2 if field.kind == "bytes" else 1
        yield f"{field.name}-one-short", {**values, field.name: row[:-size]}
        yield f"{field.name}-one-more", {**values, field.name: row + row[-size:]}


def setting_values(
    variant: Variant, present: Mapping[str, Any], numbers: Callable[[str], Sequence[Numbers]]
) -> list[dict[str, Any]]:
    """Return sets of values for fields of a variant that a query reads back.

    Args:
        variant: the variant of the request; if it has no such fields, they are texts after it.
        present: by field, what is set now.
        numbers: returns the numbers of a field as they are sent and as they are reported.
    """
    fields = [field for name in present for field in variant.fields if field.name == name]
    if not fields:
        return [dict(zip(present, texts)) for texts in _TEXTS]
    if any(map(takes_whole, fields)):
        found = [physical_values(variant, ordinary(variant, turn=turn)) for turn in _TURNS]
        return [{name: sample[name] for name in present} for sample in found]
    if len(fields) == 1 and fields[0].choices:
        return [{fields[0].name: value} for value in fields[0].choices]
    rows = [numbers(name) for name in present]
    old = [v if isinstance(v, tuple | list) else (v,) for v in present.values()]
    return [
        {field.name: row if field.many else row[0] for field, row in zip(fields, sample)}
        for sample in revealing(rows, old)
    ]


def takes_whole(field: Field) -> bool:
    """Return whether a value is set and compared as a whole: bits, bytes, text or a list."""
    return is_list(field) or any(number.bits for number in field.cases[0].numbers)


def revealing(
    rows: Sequence[Sequence[Numbers]], present: Sequence[Sequence[Any]]
) -> list[list[Any]]:
    """Return sets of values that change under a wrong scale, sign, width, order or position.

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


def _revealing(pair: Numbers, sample: int, place: int, keep: float | None) -> Any:
    step = max(map(_step, pair))
    low = max(_exact(number, number.minimum) for number in pair)
    high = min(_exact(number, number.maximum) for number in pair)
    if keep is not None and low < 0 < high and sample == _BEYOND:
        return _value(pair[0], step if keep < 0 else -step)
    if keep is not None and low < 0 < high:
        low, high = (low, -step) if keep < 0 else (step, high)
    share = _SHARES[(place + sample) % len(_SHARES)]
    if low < 0 < high:
        upwards = (place + sample) % 2 == 0
        between = share * (high if upwards else low)
    else:
        between = low + share * (high - low)
    chosen = (between, between, high, low, low + step if low >= 0 else -step)[sample]
    count = min(max(round(chosen / step), ceil(low / step)), floor(high / step))
    return _value(pair[0], count * step)


def _step(number: Number) -> Fraction:
    """Return the distance between two samples: a raw step, or a part of the range of a float."""
    if number.encoding == "float":
        return (_exact(number, number.maximum) - _exact(number, number.minimum)) / 1024
    return _exact(number, 1)


def _exact(number: Number, raw: int) -> Fraction:
    """Return the physical value of a raw value without rounding; a float must be finite."""
    if number.encoding == "float":
        return Fraction(number.physical(raw))
    return Fraction(raw * number.multiply, number.divide)


def _value(number: Number, value: Fraction) -> Any:
    return float(value) if number.real else int(value)
