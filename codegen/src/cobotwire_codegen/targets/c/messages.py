"""Describes an edition's variants for C: one struct for each, numbered by command id."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from cobotwire_codegen import lower
from cobotwire_codegen.model import Command, Edition, Field, Quantity, Type, Value, Variant
from cobotwire_codegen.render.words import allowed
from cobotwire_codegen.targets.c import names
from cobotwire_codegen.wire import size

Direction = Literal["request", "reply"]
DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


@dataclass(frozen=True, slots=True)
class Member:
    """A field in the struct of its message; ``index`` counts the raw values before it.

    A constant field has no place in the struct: its ``count`` is 0.
    """

    field: Field
    index: int
    count: int

    @property
    def declaration(self) -> str:
        """The member's name, with its shape."""
        shape = f"[{self.count}]" if isinstance(self.field.type, Value) else ""
        return names.member(self.field.name) + shape

    @property
    def text(self) -> str:
        """The comment: meaning, allowed values, size of a raw step."""
        doc = self.field.doc.rstrip(".")
        return f"{doc}: {allowed(self.field)}{''.join(steps(self.field))}."


@dataclass(frozen=True, slots=True)
class Message:
    """One variant of a request or a reply; ``number`` counts the variants of one message from 0."""

    command: Command
    direction: Direction
    number: int
    members: tuple[Member, ...]

    @property
    def symbol(self) -> str:
        """The name without the edition's prefix."""
        variant = f"_{self.number + 1}" if self.number else ""
        return f"{self.command.name}_{self.direction}{variant}"

    @property
    def fields(self) -> tuple[Member, ...]:
        """The members of the struct."""
        return tuple(member for member in self.members if member.count)

    @property
    def count(self) -> int:
        """The number of raw values in the struct."""
        return sum(member.count for member in self.members)

    @property
    def size(self) -> int:
        """The number of data bytes on the wire."""
        return sum(size(member.field.type) for member in self.members)


def messages(edition: Edition) -> list[Message]:
    """Return every variant of every message, sorted by command id, then in the table's order."""
    found = [
        Message(command, direction, number, _members(variant))
        for command in edition.commands
        for direction in DIRECTIONS
        for number, variant in enumerate(command.variants(direction))
    ]
    return sorted(found, key=lambda message: message.command.id)


def _members(variant: Variant) -> tuple[Member, ...]:
    made: list[Member] = []
    index = 0
    for field in variant:
        shapes = [len(lower.numbers(type)) for _, type in lower.cases(field)]
        count = max(shapes) if field.const is None else 0
        made.append(Member(field, index, count))
        index += count
    return tuple(made)


def steps(field: Field) -> Iterator[str]:
    """Return the physical size of one raw step, unless it is 1."""
    found: dict[str, list[str]] = {}
    for name, quantity in quantities(field):
        if quantity.scale != 1:
            found.setdefault(f"{_exact(quantity.scale)} {quantity.unit}".strip(), []).append(name)
    for step, owners in found.items():
        parts = ", ".join(filter(None, owners))
        yield f"; {parts} in steps of {step}" if parts else f"; in steps of {step}"


def quantities(field: Field) -> Iterator[tuple[str, Quantity]]:
    """Yield the quantities that a field can hold, with their names in its value or case."""
    for when, type in lower.cases(field):
        chosen = [member.name for member, _ in field.cases if member.value in when]
        yield from _parts(", ".join(chosen), type)


def _parts(name: str, type: Type) -> Iterator[tuple[str, Quantity]]:
    if isinstance(type, Value):
        yield from type.items
    elif isinstance(type, Quantity):
        yield name, type


def _exact(scale: Fraction) -> str:
    return str(scale)
