"""Rules for types: every legal value can be encoded."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Edition, Quantity, Type


def _integers(edition: Edition) -> Iterator[Quantity]:
    fields = [field for command in edition.commands for field in command.fields]
    types: list[Type] = [*edition.types, *(field.type for field in fields)]
    found = (type for type in types if isinstance(type, Quantity))
    yield from (quantity for quantity in found if not quantity.wire.is_float)


def ranges_encodable(edition: Edition) -> Iterator[Problem]:
    """Report ranges with an end that is not a multiple of the scale, or beyond the wire type."""
    for quantity in _integers(edition):
        lowest, highest = quantity.bounds
        if lowest.denominator != 1 or highest.denominator != 1:
            message = f"the range of {quantity.name} does not end at multiples of {quantity.scale}"
            yield Problem(quantity.place, "unencodable-range", message)
        elif lowest < quantity.wire.minimum or highest > quantity.wire.maximum:
            low = float(quantity.wire.minimum * quantity.scale)
            high = float(quantity.wire.maximum * quantity.scale)
            message = (
                f"the range of {quantity.name} exceeds that of its wire type, {low:g}..{high:g}"
            )
            yield Problem(quantity.place, "range-too-wide", message)


def members_fit(edition: Edition) -> Iterator[Problem]:
    """Report members with the same value, or with a value that the wire type cannot hold."""
    for type in edition.types:
        seen: dict[int, str] = {}
        for member in type.members:
            if not type.can_hold(member.value):
                message = (
                    f"{member.name} = {member.value} does not fit into {type.parts[0][1].wire.name}"
                )
                yield Problem(member.place, "value-too-wide", message)
            if member.value in seen:
                message = f"{member.name} and {seen[member.value]} are both {member.value}"
                yield Problem(member.place, "duplicate-value", message)
            seen.setdefault(member.value, member.name)


def exact_in_a_double(edition: Edition) -> Iterator[Problem]:
    """Report scales that are too fine for the doubles that both codecs compute with."""
    for quantity in _integers(edition):
        most = max(map(abs, quantity.bounds)) * quantity.scale.numerator
        if most > 2**53 or quantity.scale.denominator > 2**53:
            message = f"the scale of {quantity.name} is too fine for a double"
            yield Problem(quantity.place, "inexact-scale", message)


RULES = (exact_in_a_double, ranges_encodable, members_fit)
