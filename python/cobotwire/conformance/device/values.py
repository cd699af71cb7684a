"""Which values are tried: boundaries, and every member of a short list."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

from cobotwire.table import Field, Layout, Number

Values = tuple[Any, ...]
# What stands for a row of numbers that the arm itself told, by the units of its parts.
Known = Mapping[tuple[str, ...], tuple[float, ...]]

# What may be sent, by argument, where not every legal number is harmless.
Limits = Mapping[str, tuple[int, ...]]

# A list or range of up to so many numbers is tried whole.
SHORT = 12


def units(numbers: tuple[Number, ...]) -> tuple[str, ...]:
    """The units of a field's parts."""
    return tuple(number.unit for number in numbers)


def physical(number: Number, whole: int) -> Any:
    """The value of a whole number of the wire, as codecs give it."""
    return whole * number.multiply / number.divide if number.scaled else whole


def wholes(field: Field, number: Number) -> list[int]:
    """The numbers worth a try: all of a short list, else the ends and what is between."""
    if field.choices:
        return list(field.choices)
    low, high = number.minimum, number.maximum
    if high - low < SHORT:
        return list(range(low, high + 1))
    middle = [0, 1] if low < 0 < high else [low + 1, (low + high) // 2]
    return sorted({low, *middle, high})


def requests(form: Layout, known: Known, limits: Limits | None = None) -> list[Values]:
    """Arguments to ask with: each field in turn takes what is worth a try; the rest stay."""
    found: dict[Values, None] = {}
    for selected in selections(form):
        lists = [
            [selected[at]]
            if at in selected
            else list((limits or {}).get(field.name, ()))
            or _tried(field, numbers_of(field, selected), known)
            for at, field in enumerate(form.fields)
        ]
        base = [tried[0] for tried in lists]
        found[tuple(base)] = None
        for at, tried in enumerate(lists):
            for value in tried:
                found[(*base[:at], value, *base[at + 1 :])] = None
    return list(found)


def gentle(form: Layout) -> Values:
    """Arguments that do the least: the number nearest to one step from zero."""
    selected = next(selections(form))
    values: list[Any] = []
    for at, field in enumerate(form.fields):
        numbers = numbers_of(field, selected)
        row = [physical(number, min(max(1, number.minimum), number.maximum)) for number in numbers]
        value = tuple(row) if field.many else (field.choices[0] if field.choices else row[0])
        values.append(selected.get(at, value))
    return tuple(values)


def numbers_of(field: Field, selected: Mapping[int, int]) -> tuple[Number, ...]:
    """The parts of a field while its selector has the value that ``selected`` says."""
    if field.selector < 0:
        return field.cases[0].numbers
    chosen = selected[field.selector]
    return next(case.numbers for case in field.cases if chosen in case.when)


def selections(form: Layout) -> Iterator[dict[int, int]]:
    """Every combination of values of the fields that decide others' types, by their place."""
    places = sorted({field.selector for field in form.fields} - {-1})
    lists = [
        [
            when
            for field in form.fields
            if field.selector == at
            for c in field.cases
            for when in c.when
        ]
        for at in places
    ]
    for chosen in product(*lists):
        yield dict(zip(places, chosen))


def _tried(field: Field, numbers: tuple[Number, ...], known: Known) -> list[Any]:
    if not field.many:
        return [physical(numbers[0], whole) for whole in wholes(field, numbers[0])]
    # A row that the arm told is one that it can calculate with; any other may have no answer.
    told = known.get(units(numbers))
    zeros = tuple(
        physical(number, min(max(0, number.minimum), number.maximum)) for number in numbers
    )
    return [zeros if told is None else tuple(map(_nearest, numbers, told))]


def _nearest(number: Number, value: float) -> Any:
    whole = round(value * number.divide / number.multiply)
    return physical(number, min(max(whole, number.minimum), number.maximum))
