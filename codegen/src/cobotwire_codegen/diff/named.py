"""The types of an edition by name: what came, went, got another name, or changed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

from cobotwire_codegen.diff.finding import Finding, finding
from cobotwire_codegen.diff.match import Matched, bare, match, order
from cobotwire_codegen.diff.types import Known, shape, type_changes, wire_changes
from cobotwire_codegen.model import Edition, Enum, Flag, Quantity, Type, Value, Wire

T = TypeVar("T", Wire, Quantity | Enum | Flag | Value)


def named_types(old: Edition, new: Edition) -> tuple[Known, list[Finding]]:
    """What the named types say; and, for their users, that they said it."""
    known = Known()
    wires = match(old.wires, new.wires, _name).further(_wire)
    types = match(old.types, new.types, _name).further(shape)
    known.pairs |= {(a.name, b.name) for a, b in wires.pairs}
    known.pairs |= {(a.name, b.name) for a, b in types.pairs}
    found: list[Finding] = []
    for wire, other_wire in wires.pairs:
        found.extend(wire_changes(f"wire/{other_wire.name}", wire, other_wire))
    known.said.update(found)
    # A named tuple stands behind the quantities that it is made of, and repeats nothing of theirs.
    for type, other in types.pairs:
        found.extend(type_changes(f"types/{other.name}", type, other, known))
        known.said.update(found)
        _note(type, other, known)
    found.extend(_listed("wire", wires))
    found.extend(_listed("types", types))
    return known, found


def _name(found: Type | Wire) -> str:
    return found.name


def _wire(found: Wire) -> tuple[int, str, int]:
    return found.width, found.order, found.signed_at


def _note(old: Type, new: Type, known: Known) -> None:
    """Keep what users of the type compare themselves with."""
    if isinstance(old, Enum) and isinstance(new, Enum):
        known.enums.add((frozenset(map(bare, old.members)), frozenset(map(bare, new.members))))
    if isinstance(old, Enum | Value) and isinstance(new, Enum | Value):
        known.classes[old.class_name] = new.class_name


def _listed(section: str, matched: Matched[T]) -> Iterator[Finding]:
    """Names that came, went or changed, and the order."""
    classes = [{_class(found): found for found in side} for side in (matched.old, matched.new)]
    for found in matched.gone:
        lost = _class(found) and _class(found) not in classes[1]
        rule, what = ("class", _class(found)) if lost else ("type", found.name)
        yield finding(f"{rule}-removed", f"{section}/{found.name}", what)
    for found in matched.came:
        fresh = _class(found) and _class(found) not in classes[0]
        rule, what = ("class", _class(found)) if fresh else ("type", found.name)
        yield finding(f"{rule}-added", f"{section}/{found.name}", "", what)
    for old, new in matched.pairs:
        if old.name != new.name:
            yield finding("type-renamed", f"{section}/{new.name}", old.name, new.name)
    yield from order(section, matched, _name)


def _class(found: Type | Wire) -> str:
    return found.class_name if isinstance(found, Enum | Value) else ""
