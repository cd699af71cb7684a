"""Declares the dissector's fields: their names in filters, and their types.

A filter name means one thing. ``mycobot.angle`` is the field ``angle`` of every command that has
one. If commands use a name for different units or labels, the command's name comes in between:
``mycobot.jog_angle.direction``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import Any, NamedTuple

from cobotwire_codegen import lower
from cobotwire_codegen.model import Command, Edition, Enum, Field, Type, Value
from cobotwire_codegen.render.words import units

# The dissector declares these names for every edition; no field of a message may have them.
OWN = frozenset(
    {
        *(f"frame.{name}" for name in ("bytes", "header", "address", "length", "id", "check")),
        *("frame.command", "frame.direction", "noise", "noise.reason", "noise.text"),
        *("incomplete", "began_in", "continued_in", "request_in", "response_in", "response_time"),
        *("bad_value", "missing", "cut_off", "unanswered", "other_edition"),
    }
)
# From narrow to wide: a name that has two types gets the one that holds the values of both.
_WIDTH = ("BOOLEAN", "UINT32", "INT32", "INT64", "DOUBLE")


class Shown(NamedTuple):
    """A field of Wireshark: its display name, its name in filters, its type."""

    title: str
    filter: str
    type: str
    words: tuple[tuple[int, str], ...]
    doc: str


class Declared:
    """The distinct fields of an edition, counted from 1 as in Lua."""

    def __init__(self, edition: Edition) -> None:
        """Choose names and types from all commands; ``number`` and ``group`` declare fields."""
        self.protocol = edition.name.lower()
        self.all: list[Shown] = []
        self._numbers: dict[Shown, int] = {}
        self._ambiguous = _ambiguous(edition)
        self._types: dict[str, str] = {}
        for command, field in _uses(edition):
            for number in _all_numbers(field):
                name = self._filter(command, field, number["name"])
                self._types[name] = _wider(self._types.get(name, "BOOLEAN"), _type(field, number))

    def number(self, command: Command, field: Field, type: Type, number: dict[str, Any]) -> int:
        """Return the index of the field that shows one number."""
        name = self._filter(command, field, number["name"])
        kind = self._types[name]
        words = _words(type) if kind in ("UINT32", "INT32") else ()
        unit = f" ({units(number['unit'])})" if number["unit"] else ""
        title = (number["name"] or field.name) + unit
        return self._index(Shown(title, name, kind, words, field.doc))

    def group(self, command: Command, field: Field) -> int:
        """Return the index of the group of a field with several numbers; 0 for a single number."""
        if not isinstance(field.type, Value):
            return 0
        name = self._filter(command, field, "")
        return self._index(Shown(field.name, name, "NONE", (), field.doc))

    def text(self, name: str, doc: str) -> int:
        """Return the index of a field of text outside frames."""
        return self._index(Shown(name, self._free(f"text.{name}"), "STRING", (), doc))

    def _index(self, shown: Shown) -> int:
        if shown not in self._numbers:
            self.all.append(shown)
            self._numbers[shown] = len(self.all)
        return self._numbers[shown]

    def _filter(self, command: Command, field: Field, item: str) -> str:
        name = f"{command.name}.{field.name}" if field.name in self._ambiguous else field.name
        return self._free(f"{name}.{item}" if item else name)

    def _free(self, name: str) -> str:
        return f"{self.protocol}.{name}{'_' if name in OWN else ''}"


def _uses(edition: Edition) -> Iterator[tuple[Command, Field]]:
    for command in edition.commands:
        for field in command.fields:
            yield command, field


def _ambiguous(edition: Edition) -> set[str]:
    """Return the names that commands use for different things."""
    meanings: dict[str, dict[str, set[tuple[Any, ...]]]] = defaultdict(lambda: defaultdict(set))
    for command, field in _uses(edition):
        meanings[field.name][command.name] |= _meanings(field)
    return {
        name
        for name, users in meanings.items()
        if any(meaning != next(iter(users.values())) for meaning in users.values())
    }


def _meanings(field: Field) -> set[tuple[Any, ...]]:
    return {
        (number["name"], lower.kind(type), number["unit"], _words(type))
        for _, type in lower.cases(field)
        for number in lower.numbers(type)
    }


def _all_numbers(field: Field) -> Iterator[dict[str, Any]]:
    for _, type in lower.cases(field):
        yield from lower.numbers(type)


def _words(type: Type) -> tuple[tuple[int, str], ...]:
    return tuple((m.value, m.name) for m in type.members) if isinstance(type, Enum) else ()


def _type(field: Field, number: dict[str, Any]) -> str:
    if lower.kind(field.type) == "flag":
        return "BOOLEAN"
    if (number["multiply"], number["divide"]) != (1, 1):
        return "DOUBLE"
    if number["signed_at"] == 256 ** number["width"] - 1:
        return "UINT32"
    # An unusual sign rule may need more than 32 bits.
    return "INT32" if number["signed_at"] < 2**31 else "INT64"


def _wider(one: str, other: str) -> str:
    wider = max(one, other, key=_WIDTH.index)
    return "INT64" if {one, other} == {"UINT32", "INT32"} else wider
