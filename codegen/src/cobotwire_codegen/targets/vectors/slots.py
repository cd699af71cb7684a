"""The numbers of a message, one by one: where each stands, and what it may be."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from cobotwire_codegen import lower
from cobotwire_codegen.model import Enum, Field, Flag, Form, Quantity, Type, Value, Wire

Wholes = dict[str, tuple[int, ...]]
"""A message: by field, its numbers as they stand on the wire, before their scale."""


@dataclass(frozen=True, slots=True)
class Slot:
    """One number of a field. ``choices`` closes the list of what it may be."""

    wire: Wire
    scale: Fraction
    lowest: int
    highest: int
    choices: tuple[int, ...]

    def allows(self, whole: int) -> bool:
        """Whether the edition allows this number."""
        return whole in self.choices if self.choices else self.lowest <= whole <= self.highest

    def value(self, whole: int) -> int | float:
        """What the number stands for."""
        exact = whole * self.scale
        return whole if self.scale == 1 else float(exact)

    def word(self, whole: int) -> bytes:
        """The number's bytes."""
        word = whole % int(256**self.wire.width)
        return word.to_bytes(self.wire.width, self.wire.order)

    def sayable(self, whole: int) -> bool:
        """Whether some word reads as this number, legal or not."""
        return self.wire.minimum <= whole <= self.wire.maximum

    def read(self, data: bytes) -> int:
        """The number that bytes stand for."""
        word = int.from_bytes(data, self.wire.order)
        return word if word <= self.wire.signed_at else word - 256**self.wire.width


def slots(field: Field, form: Form, wholes: Wholes) -> tuple[Slot, ...] | None:
    """A field's numbers in a message that has these already; None if its selector picks no case."""
    if not field.by:
        return _slots(field, field.type)
    picked = wholes[field.by][0]
    for when, type in lower.cases(field):
        if picked in when:
            return _slots(field, type)
    return None


def variants(form: Form) -> Iterator[dict[str, int]]:
    """For each case that a field has: what its selector must be. One empty one if none has any."""
    pickers = [field for field in form if field.by]
    if not pickers:
        yield {}
    for field in pickers:
        for when, _ in lower.cases(field):
            yield {field.by: when[0]}


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
