"""Which requests a run sends: boundaries, short lists in full, and values that reveal mistakes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import ceil, floor
from typing import Any

from cobotwire.conformance.places import numbers_of, picks
from cobotwire.conformance.samples import RawValues, physical_values, plainest, with_row
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Field, Number, Variant

# A row of numbers that the arm itself reported, by the units of its parts; empty if its query has
# no reply, so that the arm cannot calculate with such a row.
Known = Mapping[tuple[str, ...], tuple[float, ...]]
# The raw values by argument that a run may send, where not all legal ones are harmless.
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


def as_row(value: Any) -> tuple[Any, ...]:
    """Return the numbers that a field holds, whether it is one number or a row."""
    return tuple(value) if isinstance(value, tuple | list) else (value,)


def request_of(command: Command, *values: Any) -> Request[Any]:
    """Return the typed request for values in the order and the units of the wire.

    Its variant is the first one with that number of fields.
    """
    variant = next(v for v in command.request if len(v.fields) == len(values))
    return _typed(command, {field.name: value for field, value in zip(variant.fields, values)})


def _typed(command: Command, fields: Mapping[str, Any]) -> Request[Any]:
    return command.request_type.from_fields(
        {name: tuple(v) if isinstance(v, list) else v for name, v in fields.items()}
    )


def flag_text(query: Command, value: bool | None) -> str:
    """Return what a query reports, by the name of the value if it has one: FILLED; else True."""
    if value is None:
        return "no valid reply"
    field = query.reply[0].fields[-1]
    return dict(zip(field.choices, field.labels)).get(int(value), str(value))


def arguments_of(request: Request[Any]) -> str:
    """Return the arguments of a request as a person writes them: ``joint=1, angle=20.0``."""
    return ", ".join(f"{name}={value}" for name, value in request.fields.items())


def requests(
    command: Command, variant: Variant, known: Known | None = None, limits: Limits | None = None
) -> list[Request[Any]]:
    """Return requests of a variant: each field in turn takes its samples; the rest stay.

    None of them has a row that the arm would report, but does not.
    """
    found: dict[RawValues, None] = {}
    for picked in picks(variant):
        if not all(_is_within(limits or {}, variant.fields[at], raw) for at, raw in picked.items()):
            continue
        if not all(_has_row(known or {}, field, picked) for field in variant.fields):
            continue
        lists = [
            [(picked[index],)]
            if index in picked
            else [(raw,) for raw in (limits or {}).get(field.name, ())]
            or _rows(field, numbers_of(field, picked), known or {})
            for index, field in enumerate(variant.fields)
        ]
        base = tuple(rows[0] for rows in lists)
        found[base] = None
        found.update(
            dict.fromkeys(with_row(base, at, row) for at, rows in enumerate(lists) for row in rows)
        )
    return [_typed(command, _arguments(variant, raw_values)) for raw_values in found]


def _has_row(known: Known, field: Field, picked: Mapping[int, int]) -> bool:
    return not field.many or known.get(units(numbers_of(field, picked))) != ()


def _is_within(limits: Limits, field: Field, raw: int) -> bool:
    return raw in limits.get(field.name, (raw,))


def limits_of(command: Command, variant: Variant) -> Limits:
    """Return the limits of the arguments of a variant whose legal numbers are not all harmless."""
    names = {field.name for field in variant.fields}
    for samples in command.samples:
        if {name for name, _ in samples} <= names:
            return dict(samples)
    return {}


def harmless(command: Command) -> list[Request[Any]]:
    """Return requests of a command's shortest variant, within the limits of the edition."""
    return requests(command, command.request[-1], limits=dict(*command.samples[-1:]))


def gentle(command: Command) -> Request[Any]:
    """Return the request that does the least: one step from zero, in the shortest variant."""
    text = command.request_text
    words = dict.fromkeys(text.fields, "cobot") if text else {}
    return _typed(command, gentle_values(command.request[-1]) | words)


def gentle_values(variant: Variant) -> dict[str, Any]:
    """Return the arguments that do the least: the numbers nearest to one step from zero."""
    return _arguments(variant, plainest(variant, near=1))


def _arguments(variant: Variant, raw_values: RawValues) -> dict[str, Any]:
    """Return the values of a request by name; messages compute the counts of lists."""
    counts = {field.name: ... for field in variant.fields if field.counts}
    return physical_values(variant, raw_values) | counts


def _rows(field: Field, numbers: tuple[Number, ...], known: Known) -> list[tuple[int, ...]]:
    """Return the raw values to send: all of a short list, else the ends and the middle."""
    if field.many:
        # The arm can calculate with a row that it reported; any other row may have no reply.
        reported = known.get(units(numbers), (0.0,) * len(numbers))
        raw = [round(number.steps(value)) for number, value in zip(numbers, reported)]
        return [
            tuple(
                value if value in n.choices else next(iter(n.choices), n.clamp(value))
                for n, value in zip(numbers, raw)
            )
        ]
    low, high = numbers[0].minimum, numbers[0].maximum
    if field.choices:
        return [(choice,) for choice in field.choices]
    if high - low < SHORT:
        return [(raw,) for raw in range(low, high + 1)]
    middle = [0, 1] if low < 0 < high else [low + 1, (low + high) // 2]
    return [(raw,) for raw in sorted({low, *middle, high})]


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
    step = max(map(_step, pair))
    low = max(_exact(number, number.minimum) for number in pair)
    high = min(_exact(number, number.maximum) for number in pair)
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


def _step(number: Number) -> Fraction:
    """Return the distance between two samples: a raw step, or a part of the range of a float."""
    if number.encoding == "float":
        return (_exact(number, number.maximum) - _exact(number, number.minimum)) / 1024
    return _exact(number, 1)


def _exact(number: Number, raw: int) -> Fraction:
    """Return the physical value of a raw value without rounding; floats: of a finite one."""
    if number.encoding == "float":
        return Fraction(number.physical(raw))
    return Fraction(raw * number.multiply, number.divide)


def _value(number: Number, value: Fraction) -> Any:
    return float(value) if number.real else int(value)
