"""The forms of an edition's messages, as C sees them: a struct each, numbered by command id."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from cobotwire_codegen import lower
from cobotwire_codegen.model import Command, Edition, Field, Form, Quantity, Type, Value
from cobotwire_codegen.render.words import allowed
from cobotwire_codegen.targets.c import names
from cobotwire_codegen.wire import size

Direction = Literal["request", "reply"]
DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


@dataclass(frozen=True, slots=True)
class Member:
    """A field in the struct of its message, from its ``index``-th whole number on.

    A field that is always one number has no place there: ``count`` is 0.
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
        """What it is: what it means, what it may be, how large its steps are."""
        doc = self.field.doc.rstrip(".")
        return f"{doc}: {allowed(self.field)}{''.join(steps(self.field))}."


@dataclass(frozen=True, slots=True)
class Message:
    """One form of a request or a reply; ``number`` counts the forms of one message from 0."""

    command: Command
    direction: Direction
    number: int
    members: tuple[Member, ...]

    @property
    def symbol(self) -> str:
        """Its name without the edition's prefix."""
        form = f"_{self.number + 1}" if self.number else ""
        return f"{self.command.name}_{self.direction}{form}"

    @property
    def fields(self) -> tuple[Member, ...]:
        """The members that the struct has."""
        return tuple(member for member in self.members if member.count)

    @property
    def count(self) -> int:
        """How many whole numbers the struct holds."""
        return sum(member.count for member in self.members)

    @property
    def size(self) -> int:
        """Data bytes on the wire."""
        return sum(size(member.field.type) for member in self.members)


def messages(edition: Edition) -> list[Message]:
    """Every form of every message by command id; within an id as the table has them."""
    found = [
        Message(command, direction, number, _members(form))
        for command in edition.commands
        for direction in DIRECTIONS
        for number, form in enumerate(command.forms(direction))
    ]
    return sorted(found, key=lambda message: message.command.id)


def _members(form: Form) -> tuple[Member, ...]:
    made: list[Member] = []
    index = 0
    for field in form:
        shapes = [len(lower.numbers(type)) for _, type in lower.cases(field)]
        count = max(shapes) if field.const is None else 0
        made.append(Member(field, index, count))
        index += count
    return tuple(made)


def steps(field: Field) -> Iterator[str]:
    """How large a step of the whole number is, where it is not one."""
    found: dict[str, list[str]] = {}
    for name, quantity in quantities(field):
        if quantity.scale != 1:
            found.setdefault(f"{_exact(quantity.scale)} {quantity.unit}".strip(), []).append(name)
    for step, owners in found.items():
        whose = ", ".join(filter(None, owners))
        yield f"; {whose} in steps of {step}" if whose else f"; in steps of {step}"


def quantities(field: Field) -> Iterator[tuple[str, Quantity]]:
    """The quantities that a field can hold, each with its name in its value or its case."""
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
