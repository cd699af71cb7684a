"""Lists the structs for bits, and for value types that contain floats or are in lists."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cobotwire_codegen.model import Bits, Flag, Value
from cobotwire_codegen.targets.c import names
from cobotwire_codegen.targets.c.messages import Message
from cobotwire_codegen.targets.c.storage import c_type, group_name, group_of, kind_of


@dataclass(frozen=True, slots=True)
class Group:
    """A struct that several messages may share; an item is its declaration and its comment."""

    name: str
    doc: str
    items: tuple[tuple[str, str], ...]


def groups(prefix: str, messages: list[Message]) -> Iterator[Group]:
    """Yield each struct once."""
    seen: set[str] = set()
    for message in messages:
        for member in message.members:
            type = group_of(member.field)
            if type is not None and type.name not in seen:
                seen.add(type.name)
                yield Group(group_name(prefix, type), type.doc, tuple(_items(prefix, type)))


def _items(prefix: str, type: Value | Bits) -> Iterator[tuple[str, str]]:
    for (name, part), number in zip(type.items, type.numbers):
        words = "0 or 1" if isinstance(part, Flag) else part.span
        declared = f"{c_type(prefix, kind_of(number))} {names.member(name)}"
        yield declared, f"{part.doc.rstrip('.')}: {words}."
