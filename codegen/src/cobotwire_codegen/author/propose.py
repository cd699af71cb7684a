"""Proposes vectors for the variants of messages that no vector shows."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from cobotwire_codegen.author.draft import vector_lines
from cobotwire_codegen.check.evidence import unshown
from cobotwire_codegen.model import Edition, Field, Quantity, Type, Value, Variant
from cobotwire_codegen.wire import build_frame


def proposed(edition: Edition) -> Iterator[list[str]]:
    """Yield the lines of a vector for each variant that no vector shows, in the edition's order.

    The frame is computed, so it proves nothing until a person has compared it with a source.
    """
    taken = {vector.name for vector in edition.vectors}
    for command, direction, variant in unshown(edition):
        name = f"{command.name.replace('_', '-')}-{direction}"
        free = next(n for n in _numbered(name) if n not in taken)
        taken.add(free)
        values = typical_values(variant)
        frame = build_frame(edition.frame, command, direction, values)
        yield vector_lines(free, command.name, direction, frame, values)


def _numbered(name: str) -> Iterator[str]:
    yield name
    number = 2
    while True:
        yield f"{name}-{number}"
        number += 1


def typical_values(variant: Variant) -> dict[str, object]:
    """Return legal values of a variant's fields that differ from each other where they can."""
    values: dict[str, object] = {}
    for field in variant:
        # The selector may come after the fields that it decides.
        values.setdefault(field.selector or field.name, _typical(field, field.type))
        picked = values.get(field.selector)
        cases = {member.name: type for member, type in field.cases}
        values[field.name] = _typical(field, cases.get(str(picked), field.type))
    return {field.name: values[field.name] for field in variant}


def _typical(field: Field, type: Type) -> object:
    if field.const is not None and not isinstance(type, Value):
        return type.from_raw(field.const)
    if isinstance(type, Value):
        shares = range(1, len(type.items) + 1)
        return tuple(
            _within(item, Fraction(share, len(shares) + 1))
            for share, (_, item) in zip(shares, type.items)
        )
    return _within(type, Fraction(1, 3)) if isinstance(type, Quantity) else type.smallest


def _within(type: Quantity, share: Fraction) -> object:
    """Return the value at a share of the way from the lowest to the highest one."""
    if type.choices:
        return type.from_raw(type.choices[int(len(type.choices) * share)])
    lowest, highest = type.bounds
    return type.from_raw(int(lowest + (highest - lowest) * share))
