"""Sets and unsets keys of a command or type; adds, removes, renames and changes its fields."""

from __future__ import annotations

from cobotwire_codegen import language
from cobotwire_codegen.build.parts import find
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence
from cobotwire_codegen.reader import Reader, chosen


def set_keys(node: Mapping, reader: Reader, what: str) -> tuple[Mapping, list[str]]:
    """Return a copy of a mapping with keys set and unset, and a description of the changes."""
    changed = Mapping(node.place, dict(node.entries), dict(node.keys))
    words = []
    spec = language.ChangeCommands
    for key, place, value in reader.get(spec.set):
        changed.entries[key], changed.keys[key] = value, place
        words.append(f"{key} set{_shown(value)}")
    for key in reader.get(spec.unset):
        if key not in changed.entries:
            reader.problem("nothing-to-unset", f"{what} has no key {key} to unset")
        changed.entries.pop(key, None)
        words.append(f"{key} unset")
    return changed, words


def change_fields(command: Mapping, key: str, operations: tuple[Node, ...], outer: Reader) -> str:
    """Add, remove, rename and change fields of a message; return a description."""
    node = command.entries.get(key)
    fields = list(node.items) if isinstance(node, Sequence) else []
    words = [_change_field(fields, operation, key, outer) for operation in operations]
    place = operations[0].place
    command.entries[key] = Sequence(place, tuple(fields))
    command.keys.setdefault(key, place)
    if not fields:
        del command.entries[key]
    return f"{key}: {', '.join(words)}"


def _change_field(fields: list[Node], operation: Node, key: str, outer: Reader) -> str:
    choice = language.FIELD_CHANGES[key]
    verb = chosen(operation, choice, f"a change of the {key}", outer.problems)
    if verb is None:
        return ""
    reader = Reader(operation, choice, f"a change of the {key}", outer.problems)
    if verb == "add":
        return _add(fields, reader)
    index = _index(fields, reader.get(reader.record.keys()[verb]), reader)
    return _change_one(fields, index, verb, reader) if index >= 0 else ""


def _add(fields: list[Node], reader: Reader) -> str:
    field = reader.get(language.AddRequestField.add)
    after = reader.get(language.AddRequestField.after)
    index = _index(fields, after, reader) + 1 if after else len(fields)
    assert field is not None, "the change was chosen by this key"
    fields.insert(index, field)
    return f"{_name(field)} added"


def _change_one(fields: list[Node], index: int, verb: str, reader: Reader) -> str:
    field = fields[index]
    name = _name(field)
    assert isinstance(field, Mapping), "the field was found by its name, which only a mapping has"
    if verb == "remove":
        del fields[index]
        return f"{name} removed"
    if verb == "change":
        fields[index], words = set_keys(field, reader, f"the field {name}")
        return f"{name} changed ({', '.join(words)})"
    renamed = Mapping(field.place, dict(field.entries), dict(field.keys))
    renamed.entries["name"] = reader.node(language.RenameField.to) or field.entries["name"]
    fields[index] = renamed
    return f"{name} renamed to {_name(renamed)}"


def _index(fields: list[Node], name: str, reader: Reader) -> int:
    names = [_name(node) for node in fields]
    known = find(iter(names), name, "field", reader.place, reader.problems)
    return names.index(name) if known else -1


def _name(node: Node) -> str:
    value = node.entries.get("name") if isinstance(node, Mapping) else None
    return str(value.value) if isinstance(value, Scalar) else ""


def _shown(value: Node) -> str:
    text = str(value.value) if isinstance(value, Scalar) else ""
    return f" to {text}" if text and len(text) <= 20 else ""
