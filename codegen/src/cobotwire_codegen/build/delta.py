"""Applies the changes of a delta edition to the nodes of its base.

A node that a change adds keeps its place in the changes file, so that a mistake in it is reported
there. Each change gives its reason and its evidence. A change of something that does not exist is
reported.
"""

from __future__ import annotations

from collections.abc import Callable

from cobotwire_codegen import language
from cobotwire_codegen.build.delta_fields import change_fields, set_keys
from cobotwire_codegen.build.parts import Named, Parts, find
from cobotwire_codegen.build.types import evidence
from cobotwire_codegen.errors import Problem
from cobotwire_codegen.load import Mapping, Node
from cobotwire_codegen.model import Change
from cobotwire_codegen.reader import Reader, chosen

Operation = Callable[[Parts, Reader, tuple[str, ...]], str]


def apply_changes(parts: Parts, root: Node, problems: list[Problem]) -> None:
    """Apply a changes file in its order, or one change that is part of the edition file."""
    if isinstance(root, Mapping) and "changes" not in root.entries:
        _apply(parts, root, problems)
        return
    spec = language.ChangesFile
    for node in Reader(root, spec, "the changes file", problems).get(spec.changes):
        _apply(parts, node, problems)


def _apply(parts: Parts, node: Node, problems: list[Problem]) -> None:
    verb = chosen(node, language.CHANGE, "a change", problems)
    if verb is None:
        return
    spec = language.ChangeCommands
    reader = Reader(node, language.CHANGE, "a change", problems)
    names = reader.get(reader.record.keys()[verb])
    what = OPERATIONS[verb](parts, reader, names)
    change = Change(node.place, what, reader.get(spec.why), evidence(reader, spec.evidence))
    if verb == "rename":
        names = (reader.get(language.RenameCommand.to),)
    if verb in ("change", "rename"):
        for name in names:
            parts.changes.setdefault(name, []).append(change)
    parts.general_changes.append(change)


def _remove(parts: Parts, reader: Reader, names: tuple[str, ...]) -> str:
    for name in names:
        holder = _holder(parts, reader, name)
        if holder is not None:
            del holder[name]
            parts.gone[name] = f"; this edition removes it at {reader.place}"
            parts.inherited = [each for each in parts.inherited if each.command != name]
    return f"Removed {', '.join(names)}."


def _rename(parts: Parts, reader: Reader, names: tuple[str, ...]) -> str:
    new = reader.get(language.RenameCommand.to)
    for name in names:
        holder = _holder(parts, reader, name)
        if holder is not None:
            parts.gone[name] = f"; this edition renames it to {new} at {reader.place}"
            if name in parts.unacknowledged:
                parts.unacknowledged.add(new)
            # Keep the place of the command, so that the order of the family stays the same.
            entries = [(new if key == name else key, value) for key, value in holder.items()]
            holder.clear()
            holder.update(entries)
            parts.inherited = [
                each._replace(command=new) if each.command == name else each
                for each in parts.inherited
            ]
    return f"Renamed {', '.join(names)} to {new}."


def _change(parts: Parts, reader: Reader, names: tuple[str, ...]) -> str:
    words: list[str] = []
    for name in names:
        holder = _holder(parts, reader, name)
        node = holder[name][1] if holder is not None else None
        if holder is None or not isinstance(node, Mapping):
            continue
        changed, words = set_keys(node, reader, f"the command {name}")
        for key in (language.ChangeCommands.request, language.ChangeCommands.reply):
            operations = reader.get(key)
            if operations:
                words.append(change_fields(changed, key.name, operations, reader))
        holder[name] = (holder[name][0], changed)
    return f"Changed {', '.join(names)}: {'; '.join(words) or 'nothing'}."


def _change_type(parts: Parts, reader: Reader, names: tuple[str, ...]) -> str:
    words: list[str] = []
    for name in names:
        known = (name for named in parts.types.values() for name in named)
        if not find(known, name, "type", reader.place, reader.problems):
            continue
        section = next(section for section in language.SECTIONS if name in parts.types[section])
        place, node = parts.types[section][name]
        if isinstance(node, Mapping):
            changed, words = set_keys(node, reader, f"the type {name}")
            parts.types[section][name] = (place, changed)
    return f"Changed the type {', '.join(names)}: {'; '.join(words) or 'nothing'}."


def _withdraw(parts: Parts, reader: Reader, names: tuple[str, ...]) -> str:
    """Drop vectors of the base that do not hold here."""
    for name in names:
        known = (each.vector.name for each in parts.inherited)
        if find(known, name, "vector", reader.place, reader.problems):
            parts.inherited = [each for each in parts.inherited if each.vector.name != name]
    return f"Withdrew vectors of the base: {', '.join(names)}."


def _withdraw_acks(parts: Parts, reader: Reader, names: tuple[str, ...]) -> str:
    """Drop the base's acknowledgement of some commands or of all."""
    if parts.acks is None:
        reader.problem("bad-change", "the base has no acks to withdraw")
    elif names == ("all",):
        parts.acks = None
        return "Withdrew the acknowledgement of every command."
    for name in names:
        if find(parts.commands(), name, "command", reader.place, reader.problems):
            parts.unacknowledged.add(name)
    return f"Withdrew the acknowledgement of {', '.join(names)}."


OPERATIONS: dict[str, Operation] = {
    "remove": _remove,
    "rename": _rename,
    "change": _change,
    "change_type": _change_type,
    "withdraw": _withdraw,
    "withdraw_acks": _withdraw_acks,
}


def _holder(parts: Parts, reader: Reader, name: str) -> Named | None:
    if name in parts.gone and parts.family_of(name) is None:
        reader.problem("unknown-command", f"there is no command {name}{parts.gone[name]}")
        return None
    if not find(parts.commands(), name, "command", reader.place, reader.problems):
        return None
    family = parts.family_of(name)
    return family.commands if family is not None else None
