"""Describes an edition's variants for C: one struct for each, numbered by command id.

Messages that differ only in the number of elements of a list are one variant here.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Literal

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Bits,
    Chars,
    Command,
    Edition,
    Field,
    Listed,
    Quantity,
    Type,
    Value,
    Variant,
)
from cobotwire_codegen.render.words import allowed
from cobotwire_codegen.targets.c import names
from cobotwire_codegen.targets.c.storage import Storage, storage

Direction = Literal["request", "reply"]
DIRECTIONS: tuple[Direction, ...] = ("request", "reply")


@dataclass(frozen=True, slots=True)
class Member:
    """A field in the struct of its message; ``index`` counts the raw values before it.

    A constant has no member in the struct, and neither has a field that counts the elements of a
    list: its ``count`` is 0. The member ``counter`` holds the number of elements of a list if that
    varies.
    """

    field: Field
    index: int
    count: int
    storage: Storage
    counter: str

    @property
    def name(self) -> str:
        """The member's name in C."""
        return names.member(self.field.name)

    @property
    def declaration(self) -> str:
        """The member's type, name and dimensions."""
        shape = "".join(f"[{size}]" for size in self.storage.dimensions)
        return f"{self.storage.element} {self.name}{shape}"

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
        """The highest number of raw values in the struct."""
        return sum(member.count for member in self.members)

    @property
    def size(self) -> int:
        """The least number of data bytes on the wire."""
        return sum(member.field.type.size for member in self.members)

    def sizes(self, most: int) -> set[int]:
        """Return every number of data bytes that the message can have, up to ``most``."""
        types = [member.field.type for member in self.members]
        spans = [range(type.sizes[0], type.sizes[1] + 1) for type in types if type.varies]
        units = [type.element_size for type in types if type.varies]
        fixed = sum(type.size for type in types if not type.varies)
        found = {
            fixed + sum(count * unit for count, unit in zip(counts, units))
            for counts in product(*spans)
        }
        return {size for size in found if size <= most or not spans}


def messages(edition: Edition) -> list[Message]:
    """Return every variant of every message, sorted by command id, then in the table's order.

    Replies without an id come last, in the table's order.
    """
    found = [
        Message(command, direction, number, _members(edition.name, variant))
        for command in edition.commands
        for direction in DIRECTIONS
        for number, variant in enumerate(command.variants(direction))
    ]
    return sorted(found, key=lambda message: _order(edition, message))


def _order(edition: Edition, message: Message) -> tuple[bool, int]:
    has_id = edition.frame.has_command(message.direction)
    return not has_id, message.command.id if has_id else 0


def _members(prefix: str, variant: Variant) -> tuple[Member, ...]:
    made: list[Member] = []
    index = 0
    taken = {names.member(field.name) for field in variant}
    for field in variant:
        stored = storage(prefix, field)
        count = stored.count if field.const is None and not field.counts else 0
        counter = names.counter(field.name, taken) if stored.varies else ""
        made.append(Member(field, index, count, stored, counter))
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
    if isinstance(type, Listed) and not isinstance(type.of, Chars):
        yield from _parts(name, type.of)
    elif isinstance(type, Value | Bits):
        yield from ((part, item) for part, item in type.items if isinstance(item, Quantity))
    elif isinstance(type, Quantity):
        yield name, type


def _exact(scale: Fraction) -> str:
    return str(scale)
