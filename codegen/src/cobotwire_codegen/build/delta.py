"""Changes of a delta edition, applied to the nodes of its base.

A change keeps the place of what it brings, so that a mistake in it is told where it stands. Each
gives its reason and its evidence; one that changes what is not there is a problem.
"""

from __future__ import annotations

from collections.abc import Callable

from cobotwire_codegen.build.delta_fields import change_fields, set_keys
from cobotwire_codegen.build.parts import SECTIONS, Named, Parts, find
from cobotwire_codegen.build.types import evidence
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.load import Mapping, Node, Scalar
from cobotwire_codegen.model import Change
from cobotwire_codegen.reader import Reader

Operation = Callable[[Parts, Reader, list[str]], str]


def apply_changes(parts: Parts, root: Node, problems: list[Problem]) -> None:
    """Apply a changes file, in its order; or a change that stands in the edition itself."""
    if isinstance(root, Mapping) and "changes" not in root.entries:
        _apply(parts, root, problems)
        return
    reader = Reader(root, "the changes file", problems)
    for node in reader.items("changes"):
        _apply(parts, node, problems)
    reader.done()


def _apply(parts: Parts, node: Node, problems: list[Problem]) -> None:
    reader = Reader(node, "a change", problems)
    chosen = [name for name in OPERATIONS if reader.node(name) is not None]
    if len(chosen) != 1:
        reader.problem("bad-change", f"a change is just one of {', '.join(OPERATIONS)}")
        return
    names = reader.names(chosen[0])
    for key in _KEYS.get(chosen[0], ()):
        reader.node(key)
    what = OPERATIONS[chosen[0]](parts, reader, names)
    change = Change(node.place, what, reader.text("why"), evidence(reader))
    if not change.evidence:
        reader.problem("no-evidence", "a change must carry its evidence")
    reader.done()
    if chosen[0] == "rename":
        names = [reader.text("to", "")]
    if chosen[0] in ("change", "rename"):
        for name in names:
            parts.changes.setdefault(name, []).append(change)
    parts.general_changes.append(change)


def _remove(parts: Parts, reader: Reader, names: list[str]) -> str:
    for name in names:
        holder = _holder(parts, reader, name)
        if holder is not None:
            del holder[name]
    return f"Removed {', '.join(names)}."


def _rename(parts: Parts, reader: Reader, names: list[str]) -> str:
    new = reader.text("to")
    for name in names:
        holder = _holder(parts, reader, name)
        if holder is not None:
            # In its old place, so that the order of the family stays.
            entries = [(new if key == name else key, value) for key, value in holder.items()]
            holder.clear()
            holder.update(entries)
    return f"Renamed {', '.join(names)} to {new}."


def _change(parts: Parts, reader: Reader, names: list[str]) -> str:
    words: list[str] = []
    for name in names:
        holder = _holder(parts, reader, name)
        node = holder[name][1] if holder is not None else None
        if holder is None or not isinstance(node, Mapping):
            continue
        changed, words = set_keys(node, reader, f"the command {name}")
        for key in ("request", "reply"):
            operations = list(reader.items(key))
            if operations:
                words.append(change_fields(changed, key, operations, reader))
        holder[name] = (holder[name][0], changed)
    return f"Changed {', '.join(names)}: {'; '.join(words) or 'nothing'}."


def _change_type(parts: Parts, reader: Reader, names: list[str]) -> str:
    words: list[str] = []
    for name in names:
        known = (name for named in parts.types.values() for name in named)
        if not find(known, name, "type", reader.place, reader.problems):
            continue
        section = next(section for section in SECTIONS if name in parts.types[section])
        place, node = parts.types[section][name]
        if isinstance(node, Mapping):
            changed, words = set_keys(node, reader, f"the type {name}")
            parts.types[section][name] = (place, changed)
    return f"Changed the type {', '.join(names)}: {'; '.join(words) or 'nothing'}."


def _withdraw(parts: Parts, reader: Reader, names: list[str]) -> str:
    """Drop vectors of the base that do not hold here."""
    known = {_vector_name(node): node for node in parts.vectors}
    for name in names:
        if find(iter(known), name, "vector", reader.place, reader.problems):
            parts.vectors.remove(known[name])
    return f"Withdrew vectors of the base: {', '.join(names)}."


OPERATIONS: dict[str, Operation] = {
    "remove": _remove,
    "rename": _rename,
    "change": _change,
    "change_type": _change_type,
    "withdraw": _withdraw,
}


# The keys that a change may have, whether or not what it changes is there.
_KEYS = {
    "rename": ("to",),
    "change": ("set", "unset", "request", "reply"),
    "change_type": ("set", "unset"),
}


def _vector_name(node: Node) -> str:
    for key in ("example", "name"):
        value = node.entries.get(key) if isinstance(node, Mapping) else None
        if isinstance(value, Scalar):
            return f"example-{value.value}" if key == "example" else str(value.value)
    return ""


def _holder(parts: Parts, reader: Reader, name: str) -> Named | None:
    if not find(parts.commands(), name, "command", reader.place, reader.problems):
        return None
    family = parts.family_of(name)
    return family.commands if family is not None else None
