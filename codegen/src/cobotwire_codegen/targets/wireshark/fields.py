"""Declares the dissector's fields: their names in filters, and their types.

Each filter name has one meaning. ``mycobot.angle`` is the field ``angle`` of every command that has
one. If commands use a field name with different units or labels, the filter name also contains the
command's name: ``mycobot.jog_angle.direction``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from functools import reduce
from typing import Any, NamedTuple

from cobotwire_codegen import lower
from cobotwire_codegen.model import Command, Edition, Field, Type
from cobotwire_codegen.targets.wireshark.leaves import Leaf, group_kind, leaves

# The dissector declares these names for every edition; no field of a message may have them.
OWN = frozenset(
    {
        *(f"frame.{name}" for name in ("bytes", "header", "address", "length", "id", "check")),
        *("frame.command", "frame.direction", "noise", "noise.reason", "noise.text"),
        *("incomplete", "began_in", "continued_in", "request_in", "response_in", "response_time"),
        *("bad_value", "missing", "cut_off", "unanswered", "failed", "other_edition"),
    }
)
# From narrow to wide: a name that has two types gets one that holds the values of both.
_WIDTH = (
    "BOOLEAN",
    *(f"UINT{bits}" for bits in (8, 16, 24, 32)),
    *(f"INT{bits}" for bits in (8, 16, 24, 32)),
    *("INT64", "FLOAT", "DOUBLE"),
)
# Fields of these kinds never share a filter name with fields of another kind.
_APART = {"STRING": "text", "BYTES": "bytes", "NONE": "group"}


class Shown(NamedTuple):
    """A field of Wireshark: its display name, its name in filters, its type.

    If it shows some bits of a word, ``mask`` selects them, and ``word`` is the word's size in bits.
    """

    title: str
    filter: str
    type: str
    words: tuple[tuple[int, str], ...]
    doc: str
    mask: int = 0
    word: int = 0


class Declared:
    """The distinct fields of an edition, counted from 1 as in Lua."""

    def __init__(self, edition: Edition) -> None:
        """Choose names and types from all commands; ``leaf`` and ``group`` declare fields."""
        self.protocol = edition.name.lower()
        self.all: list[Shown] = []
        self._numbers: dict[Shown, int] = {}
        self._ambiguous = _ambiguous(edition)
        self._sorts: dict[str, list[str]] = defaultdict(list)
        self._kinds: dict[str, set[tuple[str, int]]] = defaultdict(set)
        for command, field in _uses(edition):
            for item, kind, mask in _all_kinds(field):
                self._kinds[self._filter(command, field, item, kind)].add((kind, mask))

    def leaf(self, command: Command, field: Field, leaf: Leaf) -> int:
        """Return the index of the field that shows a leaf."""
        kind, name, mask = self._declared(command, field, leaf.item, leaf.kind)
        words = leaf.words if "INT" in kind and kind != "INT64" else ()
        unit = f" ({leaf.unit})" if leaf.unit else ""
        title = (leaf.item or field.name) + unit
        word = 8 * leaf.reading["width"] if mask else 0
        return self._index(Shown(title, name, kind, words, leaf.doc or field.doc, mask, word))

    def group(self, command: Command, field: Field) -> int:
        """Return the index of the group of a field with several leaves; 0 if it has none."""
        kind = group_kind(field.type)
        if not kind:
            return 0
        kind, name, _ = self._declared(command, field, "", kind)
        return self._index(Shown(field.name, name, kind, (), field.doc))

    def text(self, name: str, doc: str) -> int:
        """Return the index of a field of text outside frames."""
        return self._index(Shown(name, self._free(f"text.{name}"), "STRING", (), doc))

    def _declared(
        self, command: Command, field: Field, item: str, kind: str
    ) -> tuple[str, str, int]:
        """Return the type, the filter name and the mask under which a value is declared."""
        name = self._filter(command, field, item, kind)
        # If values have several masks, no mask is declared, and the dissector passes the number
        # itself.
        masks = {mask for _, mask in self._kinds[name]} if len(self._kinds[name]) == 1 else {0}
        return reduce(_wider, sorted({each for each, _ in self._kinds[name]})), name, masks.pop()

    def _index(self, shown: Shown) -> int:
        if shown not in self._numbers:
            self.all.append(shown)
            self._numbers[shown] = len(self.all)
        return self._numbers[shown]

    def _filter(self, command: Command, field: Field, item: str, kind: str) -> str:
        name = f"{command.name}.{field.name}" if field.name in self._ambiguous else field.name
        name = f"{name}.{item}" if item else name
        sort = _APART.get(kind, "")
        if sort not in self._sorts[name]:
            self._sorts[name].append(sort)
        first = sort == self._sorts[name][0]
        return self._free(name if first else f"{name}_{sort or 'number'}")

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
        (leaf.item, _sort(leaf, type), leaf.unit, leaf.mask, leaf.words)
        for _, type in lower.cases(field)
        for leaf in leaves(type)
    }


def _sort(leaf: Leaf, type: Type) -> str:
    """Return the kind of a leaf without its width."""
    return _APART.get(leaf.kind) or lower.kind(type)


def _all_kinds(field: Field) -> Iterator[tuple[str, str, int]]:
    """Yield the item, the kind and the mask of each field that shows a part of a message."""
    for _, type in lower.cases(field):
        if kind := group_kind(type):
            yield "", kind, 0
        for leaf in leaves(type):
            yield leaf.item, leaf.kind, leaf.mask


def _wider(one: str, other: str) -> str:
    """Return a type that holds the values of two types."""
    if one in _APART:
        return one
    narrow, wide = sorted((one, other), key=_WIDTH.index)
    if wide.startswith("INT") and narrow.startswith("UINT"):
        return "INT64"
    return "DOUBLE" if wide == "FLOAT" and narrow not in ("FLOAT", "BOOLEAN") else wide
