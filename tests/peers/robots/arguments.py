"""Choose arguments from a table: the ends of every range, and values inside of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cobotwire.protocol.table import Command, Field, Variant

Arguments = tuple[Any, ...]
TEXTS = ("home", "secret words")


class Named(tuple[Any, ...]):
    """Arguments with the names that our method has for them; some can be given by name only."""

    names: tuple[str, ...]


def arguments_of(command: Command) -> Iterator[Arguments]:
    """Return arguments of a command, for each variant of its request, as a program gives them."""
    if command.request_text is not None:
        yield TEXTS[: len(command.request_text.fields)]
        return
    for variant in command.request:
        for values in (*corners(variant), *inside(variant)):
            yield as_called(command, variant, values)


def as_called(command: Command, variant: Variant, values: Arguments) -> Named:
    """Return decoded values as arguments: lists, integers, and radians; without constants."""
    pairs = zip(variant.fields, values, strict=True)
    fields = {f.name: value for f, value in pairs if f.const is None and not f.counts}
    request = command.request_type.from_fields(fields)
    names = [name for name in command.argument_names if name in fields]
    found = Named(plain(getattr(request, name)) for name in names)
    found.names = tuple(names)
    return found


def plain(value: Any) -> Any:
    """Return a number as an integer if it is one.

    The maker's classes accept neither a bool for 0 or 1, nor 90.0 as a limit.
    """
    if isinstance(value, int | float):
        return int(value) if value == int(value) else value
    return [plain(each) for each in value] if isinstance(value, tuple) else value


def corners(variant: Variant) -> Iterator[Arguments]:
    """Return the lowest and the highest values of a variant, for each value of its selectors."""
    selectors = {field.selector for field in variant.fields} - {-1}
    picks: list[int | None] = [*_picks(variant)]
    for pick in picks or [None]:
        for high in (False, True):
            yield tuple(
                pick if index in selectors else end(field, high, pick)
                for index, field in enumerate(variant.fields)
            )


def inside(variant: Variant) -> Iterator[Arguments]:
    """Return values inside of the corners, for the lowest selector: first midpoints, then others.

    The other values are a few steps above the lowest. Each field has more steps than the one
    before, so that all fields differ. The maker's classes truncate some of them.
    """
    if not any(_is_range(field) for field in variant.fields):
        return
    selectors = {field.selector for field in variant.fields} - {-1}
    pick = min(_picks(variant), default=None)
    for middle in (_middle, _next_step):
        yield tuple(
            pick if index in selectors else middle(field, pick, index)
            for index, field in enumerate(variant.fields)
        )


def end(field: Field, high: bool, pick: int | None = None) -> Any:
    """Return the lowest or the highest value of a field, in the case that ``pick`` selects."""
    case = field.case(pick)
    assert case is not None, f"{field.name} has a case for {pick}"
    if field.const is not None:
        return field.physical([field.const])
    raws = [number.maximum if high else number.minimum for number in case.numbers]
    if field.choices:
        raws = [field.choices[-1 if high else 0]]
    return _value(field, pick, raws)


def _value(field: Field, pick: int | None, raws: list[int]) -> Any:
    case = field.case(pick)
    assert case is not None
    values = [number.physical(raw) for raw, number in zip(raws, case.numbers, strict=True)]
    return field.present(values) if field.many else values[0]


def _picks(variant: Variant) -> list[int]:
    return sorted({w for field in variant.fields for case in field.cases for w in case.when})


def _is_range(field: Field) -> bool:
    return field.const is None and not field.choices


def _middle(field: Field, pick: int | None, index: int) -> Any:
    low, high = end(field, False, pick), end(field, True, pick)
    if not _is_range(field) or isinstance(low, str | bytes):
        return low
    if isinstance(low, tuple) and not field.each:
        return tuple(_halfway(a, b) for a, b in zip(low, high, strict=True))
    return low if field.each else _halfway(low, high)


def _halfway(low: float, high: float) -> float:
    return type(low)(int((low + high) / 2))


def _next_step(field: Field, pick: int | None, index: int) -> Any:
    case = field.case(pick)
    assert case is not None
    if not _is_range(field) or field.kind in ("text", "bytes") or field.each:
        return end(field, False, pick)
    steps = enumerate(case.numbers, start=index + 1)
    raws = [min(number.minimum + step, number.maximum) for step, number in steps]
    return _value(field, pick, raws)
