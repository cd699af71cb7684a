"""Compares wire types and the types of fields."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from cobotwire_codegen.diff import prose, quantities, words
from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import bare, match, order, renamed
from cobotwire_codegen.model import (
    Bits,
    Chars,
    Enum,
    Listed,
    Member,
    Octets,
    Quantity,
    Type,
    Value,
    Wire,
)
from cobotwire_codegen.model.shapes import Shaped


@dataclass
class Known:
    """The findings of named types, which the fields that use them do not repeat.

    ``pairs`` are the old and new names of one type; ``classes`` the classes that were renamed;
    ``enums`` the old and new members of one enum.
    """

    reported: set[Finding] = field(default_factory=set)
    pairs: set[tuple[str, str]] = field(default_factory=set)
    classes: dict[str, str] = field(default_factory=dict)
    enums: set[tuple[frozenset[Any], frozenset[Any]]] = field(default_factory=set)

    def reports_members(self, old: Sequence[Member], new: Sequence[Member]) -> bool:
        """Return whether an enum with exactly these members reports how they changed."""
        return (frozenset(map(bare, old)), frozenset(map(bare, new))) in self.enums

    def unreported(
        self,
        old: Type | Wire,
        new: Type | Wire,
        section: str,
        where: str,
        compare: Callable[[str], Iterable[Finding]],
    ) -> Iterator[Finding]:
        """Return the findings of a field that the entry of its type does not report."""
        same = (old.name, new.name) in self.pairs
        if not same:
            yield finding("type-replaced", where, old.name, new.name)
        for general, here in zip(compare(f"{section}/{new.name}"), compare(where)):
            # If the type was replaced, a different description is not a change of its own.
            if general not in self.reported if same else here.level != "docs":
                yield here


def wire_changes(where: str, old: Wire, new: Wire) -> Iterator[Finding]:
    """Compare how raw values are encoded."""
    if old.width != new.width:
        yield finding("width-changed", where, old.width, new.width)
    if old.order != new.order and max(old.width, new.width) > 1:
        yield finding("byte-order-changed", where, old.order, new.order)
    elif old.order != new.order:
        # A single byte has no order, so the difference is only in the documentation.
        yield from prose.doc(where, f"{old.order} end first", f"{new.order} end first")
    if old.encoding != new.encoding:
        yield finding("encoding-changed", where, old.encoding, new.encoding)
    unsigned = old.signed_at == old.top and new.signed_at == new.top
    # A float has a sign of its own.
    comparable = old.rule.has_sign_rule and new.rule.has_sign_rule
    if old.signed_at != new.signed_at and comparable and not unsigned:
        yield finding("sign-rule-changed", where, words.sign(old), words.sign(new))
    yield from prose.doc(where, old.doc, new.doc)
    yield from prose.source(where, old.source, new.source)
    yield from prose.disputes(where, old.disputed, new.disputed)


def type_changes(where: str, old: Type, new: Type, known: Known) -> Iterator[Finding]:
    """Compare two types of any kind."""
    if isinstance(old, Value) and isinstance(new, Value):
        yield from _value(where, old, new, known)
    elif isinstance(old, Shaped) or isinstance(new, Shaped):
        yield from _shape(where, old, new, known)
    elif isinstance(old, Value) or isinstance(new, Value) or old.kind != new.kind:
        yield from _kind(where, old, new)
    else:
        yield from known.unreported(
            old.wire, new.wire, "wire", where, lambda at: wire_changes(at, old.wire, new.wire)
        )
    if isinstance(old, Quantity) and isinstance(new, Quantity):
        yield from quantities.changes(where, old, new)
    if isinstance(old, Enum) and isinstance(new, Enum):
        yield from _enum(where, old, new)
    yield from prose.doc(where, old.doc, new.doc)


def wire_shape(type: Type) -> list[tuple[int, str, int, str]]:
    """Return how the raw values of a type are encoded."""
    return [
        (n["width"], n["order"], n["signed_at"], n.get("encoding", "integer")) for n in type.numbers
    ]


def shape(found: Type) -> tuple[Any, ...]:
    """Return a type without its names and descriptions."""
    return found.kind, found.numbers, found.choices, found.sizes


def _shape(where: str, old: Type, new: Type, known: Known) -> Iterator[Finding]:
    """Compare two types if at least one of them is bits, bytes, a text or a list."""
    if not isinstance(old, Shaped) or not isinstance(new, Shaped) or old.kind != new.kind:
        yield from _kind(where, old, new)
        return
    if isinstance(old, Bits) and isinstance(new, Bits):
        yield from _class(where, old.class_name, new.class_name)
    if _facts(old) != _facts(new):
        yield finding("shape-changed", where, _facts(old), _facts(new))
    if isinstance(old, Listed) and isinstance(new, Listed):
        yield from _item(f"{where}/of", old.of, new.of, known)
    if isinstance(old, Bits) and isinstance(new, Bits):
        yield from known.unreported(
            old.wire, new.wire, "wire", where, lambda at: wire_changes(at, old.wire, new.wire)
        )
        for before, after in zip(old.bit_parts, new.bit_parts):
            yield from type_changes(f"{where}/{after.name}", before.type, after.type, known)


def _facts(found: Bits | Octets | Chars | Listed) -> str:
    """Describe everything about a type that matters on the wire."""
    sizes = "..".join(map(str, dict.fromkeys(found.sizes)))
    if isinstance(found, Bits):
        parts = [
            f"{part.name} {part.type.name} {part.shift}+{part.count}" for part in found.bit_parts
        ]
        return f"bits {', '.join(parts)} of {found.wire.name}"
    if isinstance(found, Listed):
        return f"{sizes} x {found.of.name}"
    if isinstance(found, Chars):
        padding = "" if found.padding is None else f", padded with {found.padding:#04x}"
        return f"{sizes} bytes of {found.encoding}{padding}"
    return f"{sizes} bytes"


def _kind(where: str, old: Type, new: Type) -> Iterator[Finding]:
    yield finding("type-kind-changed", where, old.kind, new.kind)
    if wire_shape(old) != wire_shape(new):
        sizes = ["+".join(str(word[0]) for word in wire_shape(found)) for found in (old, new)]
        yield finding("type-bytes-changed", where, *(f"{size} byte(s)" for size in sizes))


def _enum(where: str, old: Enum, new: Enum) -> Iterator[Finding]:
    yield from _class(where, old.class_name, new.class_name)
    yield from members(where, old.members, new.members)
    yield from prose.source(where, old.source, new.source)


def _class(where: str, old: str, new: str) -> Iterator[Finding]:
    if old != new:
        yield finding("class-renamed", where, old, new)


def members(where: str, old: Sequence[Member], new: Sequence[Member]) -> Iterator[Finding]:
    """Compare the members of an enum: by name, the remaining ones by raw value."""
    matched = match(old, new, lambda member: member.name).further(lambda member: member.value)
    for member in matched.removed:
        yield finding("enum-member-removed", f"{where}/{member.name}", words.member(member))
    for member in matched.added:
        yield finding("enum-member-added", f"{where}/{member.name}", "", words.member(member))
    for before, after in matched.pairs:
        at = f"{where}/{after.name}"
        if before.name != after.name:
            yield finding("enum-member-renamed", at, before.name, after.name)
        if before.value != after.value:
            shown = words.member(before), words.member(after)
            yield finding("enum-member-renumbered", at, *shown)
        if before.value == after.value and before.falsy != after.falsy:
            shown = words.truth(before), words.truth(after)
            yield finding("enum-member-truth-changed", at, *shown)
        yield from prose.doc(at, before.doc, after.doc)
    yield from order(where, matched, lambda member: member.name)


def _value(where: str, old: Value, new: Value, known: Known) -> Iterator[Finding]:
    yield from _class(where, old.class_name, new.class_name)
    names = [[name for name, _ in side.items] for side in (old, new)]
    changed = renamed(*names)
    if changed is None:
        yield finding("items-changed", where, *map(words.names, names))
    for before, after in (changed or {}).items():
        yield finding("item-renamed", f"{where}/{after}", before, after)
    parts = dict(new.items)
    for name, item in old.items:
        after = (changed or {}).get(name, name)
        if after in parts:
            yield from _item(f"{where}/{after}", item, parts[after], known)


def _item(where: str, old: Type, new: Type, known: Known) -> Iterator[Finding]:
    yield from known.unreported(
        old, new, "types", where, lambda at: type_changes(at, old, new, known)
    )
