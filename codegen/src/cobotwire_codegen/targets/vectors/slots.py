"""Splits messages into single numbers, with their places and legal values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Enum,
    Field,
    Flag,
    Quantity,
    Type,
    Value,
    Variant,
    Wire,
    floats,
)

RawValues = dict[str, tuple[int, ...]]
"""A message: its raw values by field."""


@dataclass(frozen=True, slots=True)
class Slot:
    """One number of a field. ``choices``, if there are any, are its only legal raw values."""

    wire: Wire
    scale: Fraction
    lowest: int
    highest: int
    choices: tuple[int, ...]

    def allows(self, raw: int) -> bool:
        """Return whether the edition allows a raw value."""
        return raw in self.choices if self.choices else self.lowest <= raw <= self.highest

    def value(self, raw: int) -> int | float:
        """Return the physical value of a raw value."""
        if self.wire.is_float:
            return float(floats.exact_of(raw, self.wire.width))
        exact = raw * self.scale
        return raw if self.scale == 1 else float(exact)

    def encode(self, raw: int) -> bytes:
        """Return the bytes of a raw value."""
        return self.wire.bytes_of(raw)

    def encodable(self, raw: int) -> bool:
        """Return whether some bytes decode to a raw value, legal or not."""
        return self.wire.minimum <= raw <= self.wire.maximum

    def read(self, data: bytes) -> int:
        """Return the raw value of bytes."""
        return self.wire.raw_of(data)


def slots(field: Field, variant: Variant, raw_values: RawValues) -> tuple[Slot, ...] | None:
    """Return a field's numbers in a message; None if its selector picks no case."""
    if not field.selector:
        return _slots(field, field.type)
    picked = raw_values[field.selector][0]
    for when, type in lower.cases(field):
        if picked in when:
            return _slots(field, type)
    return None


def case_choices(variant: Variant) -> Iterator[dict[str, int]]:
    """Yield the selector values for each case; one empty entry if there are no cases."""
    pickers = [field for field in variant if field.selector]
    if not pickers:
        yield {}
    for field in pickers:
        for when, _ in lower.cases(field):
            yield {field.selector: when[0]}


def _slots(field: Field, type: Type) -> tuple[Slot, ...]:
    choices = lower.field_choices(field)
    if isinstance(type, Value):
        return tuple(_quantity(item, item.choices) for _, item in type.items)
    if isinstance(type, Quantity):
        return (_quantity(type, choices),)
    assert isinstance(type, Enum | Flag)
    return (Slot(type.wire, Fraction(1), min(choices), max(choices), choices),)


def _quantity(type: Quantity, choices: tuple[int, ...]) -> Slot:
    lowest, highest = type.bounds
    return Slot(type.wire, type.scale, int(lowest), int(highest), choices)
