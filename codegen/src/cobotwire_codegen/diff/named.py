"""Compares the types of editions: added, removed, renamed and changed ones."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import Matched, bare, match, order
from cobotwire_codegen.diff.types import Known, shape, type_changes, wire_changes
from cobotwire_codegen.model import Edition, Type, Wire

T = TypeVar("T", Wire, Type)


def named_types(old: Edition, new: Edition) -> tuple[Known, list[Finding]]:
    """Return the differences that fields must not report again, and the findings of named types."""
    known = Known()
    wires = match(old.wires, new.wires, _name).further(_wire)
    types = match(old.types, new.types, _name).further(shape)
    known.pairs |= {(a.name, b.name) for a, b in wires.pairs}
    known.pairs |= {(a.name, b.name) for a, b in types.pairs}
    found: list[Finding] = []
    for wire, other_wire in wires.pairs:
        found.extend(wire_changes(f"wire/{other_wire.name}", wire, other_wire))
    known.reported.update(found)
    # Value types are listed after the quantities, so that they do not repeat their findings.
    for type, other in types.pairs:
        if type != other:
            found.extend(type_changes(f"types/{other.name}", type, other, known))
            known.reported.update(found)
        _note(type, other, known)
    found.extend(_listed("wire", wires))
    found.extend(_listed("types", types))
    return known, found


def _name(found: Type | Wire) -> str:
    return found.name


def _wire(found: Wire) -> tuple[int, str, int, str]:
    return found.width, found.order, found.signed_at, found.encoding


def _note(old: Type, new: Type, known: Known) -> None:
    """Record the members and class names that fields of this type would report again."""
    if old.members and new.members:
        known.enums.add((frozenset(map(bare, old.members)), frozenset(map(bare, new.members))))
    if old.class_name and new.class_name:
        known.classes[old.class_name] = new.class_name


def _listed(section: str, matched: Matched[T]) -> Iterator[Finding]:
    """Report names that were added, removed or changed, and the order."""
    classes = [{_class(found): found for found in side} for side in (matched.old, matched.new)]
    for found in matched.removed:
        lost = _class(found) and _class(found) not in classes[1]
        rule, what = ("class", _class(found)) if lost else ("type", found.name)
        yield finding(f"{rule}-removed", f"{section}/{found.name}", what)
    for found in matched.added:
        fresh = _class(found) and _class(found) not in classes[0]
        rule, what = ("class", _class(found)) if fresh else ("type", found.name)
        yield finding(f"{rule}-added", f"{section}/{found.name}", "", what)
    for old, new in matched.pairs:
        if old.name != new.name:
            yield finding("type-renamed", f"{section}/{new.name}", old.name, new.name)
    yield from order(section, matched, _name)


def _class(found: Type | Wire) -> str:
    return "" if isinstance(found, Wire) else found.class_name
