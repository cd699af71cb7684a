"""Writes a module in Rust for each edition: typed messages for the crate ``cobotwire``.

Each command is stated once; macros of the crate make its request, its blocking method and its
asynchronous method. The table comes with it as JSON, which the crate reads on first use.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Bits,
    Chars,
    Command,
    Edition,
    Enum,
    Flag,
    Listed,
    Octets,
    Quantity,
    Type,
    Value,
)
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.render import Files, environment, with_used_types
from cobotwire_codegen.render.arguments import arguments
from cobotwire_codegen.render.escape_markdown import escaped
from cobotwire_codegen.render.parameters import Parameter, parameters, reply_parameters, results

# Keywords of Rust that the check of names allows, because Python does not have them.
_WORDS = """
    abstract become box const do dyn enum extern final fn gen impl let loop macro match mod move mut
    override priv pub ref static struct trait type typeof unsafe unsized use virtual where
"""
_KEYWORDS = frozenset(_WORDS.split())
_NOT_EVEN_RAW = frozenset({"Self", "crate", "self", "super"})
# The names that generated modules use without a path, and the methods of every typed client.
_TYPES = frozenset({"Async", "Option", "Self", "String", "Value", "Vec"})
_METHODS = frozenset({"acknowledged", "clone", "over", "with", "opened"})
# What only people read; the editions in the docs site have it.
_TEXTS = """
    doc place lines notes disputed changes firmware document generated samples agrees_with
"""
_FOR_PEOPLE = frozenset(_TEXTS.split())


def render_rust(edition: Edition, templates: Path | None = None) -> Files:
    """Return the edition's module and its table; ``templates`` replace the shipped ones."""
    jinja = environment(templates)
    jinja.filters.update(rustdoc=rustdoc, rust_name=identifier, camel=camel)
    edition = with_used_types(edition)
    shown = escaped(edition)
    text = jinja.get_template("rust/edition.rs.j2").render(
        edition=shown,
        name=type_name(shown.class_name),
        commands=[_Shown(shown, command) for command in shown.commands],
        shape=_Shape(),
    )
    return {
        PurePosixPath(f"{edition.name}.rs"): text,
        PurePosixPath(f"{edition.name}.json"): stripped(edition_json(edition)),
    }


def render_every_rust(found: Sequence[Edition]) -> Files:
    """Return the modules of all editions, and the module that lists them, each with its feature."""
    made: Files = {}
    for edition in found:
        made |= render_rust(edition)
    index = environment(None).get_template("rust/mod.rs.j2")
    made[PurePosixPath("mod.rs")] = index.render(editions=found)
    return made


def stripped(table: str) -> str:
    """Return the text of an ``edition.json`` without what only people read."""
    document = json.loads(table)
    mark = {"generated": document["generated"]}
    lines = []
    for key, value in (mark | _without(document)).items():
        if isinstance(value, list):
            rows = ",\n".join(_compact(_without(row)) for row in value)
            lines.append(f'"{key}":[\n{rows}\n]')
        else:
            lines.append(f'"{key}":{_compact(_without(value))}')
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _without(value: Any) -> Any:
    """Return a record without texts for people, also in its messages and members."""
    if not isinstance(value, dict):
        return value
    kept = {key: each for key, each in value.items() if key not in _FOR_PEOPLE}
    for key in ("request", "reply"):
        if key in kept and isinstance(kept[key], list):
            kept[key] = [[_without(field) for field in variant] for variant in kept[key]]
    if isinstance(kept.get("members"), list):
        kept["members"] = [_without(member) for member in kept["members"]]
    return kept


def _compact(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))


def identifier(name: str) -> str:
    """Return the name of a field or argument; the macros remove what is added to keywords."""
    if name in _NOT_EVEN_RAW:
        return f"{name}_"
    return f"r#{name}" if name in _KEYWORDS else name


def type_name(name: str) -> str:
    """Return the name of a type, other than those that the module uses."""
    return f"{name}_" if name in _TYPES else name


def camel(name: str) -> str:
    """Return the name of an enum's variant: ``POWER_ON`` gives ``PowerOn``."""
    words = [word[:1] + word[1:].lower() for word in name.split("_")]
    # Digits that follow digits keep their line: 1_2 is not 12.
    joined = re.sub(r"(?<=\d)_(?=\d)", "_", "_".join(words))
    made = re.sub(r"_(?=\D)|(?<=\D)_", "", joined)
    return type_name(made)


def rustdoc(text: str, indent: int = 0) -> str:
    """Return lines of documentation, one for each paragraph of a text that is escaped already."""
    lines = [" ".join(line.split()) for line in text.splitlines() or [""]]
    # Signs that change the direction of text would be an error in a comment.
    safe = ("".join(c if c.isprintable() else "\ufffd" for c in line) for line in lines)
    return "\n".join(f"{' ' * indent}/// {line}".rstrip() for line in safe)


class _Shape:
    """The types of values in Rust, as arguments and as results."""

    def argument(self, parameter: Parameter) -> str:
        """Return the type of an argument; it is optional if a call may leave it out."""
        found = _one(map(self._given, parameter.types))
        left_out = parameter.may_be_none or parameter.default is not None
        return f"Option<{found}>" if left_out else found

    def result(self, parameter: Parameter, *, optional: bool | None = None) -> str:
        """Return the type of a field of a reply."""
        types = parameter.types
        same = len(types) == 1 or not all(isinstance(type, Value) for type in types)
        found = _one(map(self.reported if same else self._given, types))
        absent = parameter.optional if optional is None else optional
        return f"Option<{found}>" if absent else found

    def _given(self, type: Type) -> str:
        if isinstance(type, Value | Bits):
            return _array(type)
        if isinstance(type, Listed):
            return f"Vec<{self._given(type.of)}>"
        return self.reported(type)

    def reported(self, type: Type) -> str:
        """Return the type of a value in a reply."""
        if isinstance(type, Value):
            return _array(type) if self.is_of_joints(type) else type_name(type.class_name)
        if isinstance(type, Enum | Bits):
            return type_name(type.class_name)
        if isinstance(type, Listed):
            return f"Vec<{self.reported(type.of)}>"
        return _scalar(type)

    def array(self, type: Value | Bits) -> str:
        """Return the array that has the numbers of a row."""
        return _array(type)

    def is_of_joints(self, type: Type) -> bool:
        """Return whether a row has a number for each joint, so that it needs no other names."""
        parts = type.items if isinstance(type, Value) else ()
        return [name for name, _ in parts] == [f"j{n}" for n in range(1, len(parts) + 1)]

    def item(self, type: Quantity | Enum | Flag) -> str:
        """Return the type of a part of a row."""
        return type_name(type.class_name) if isinstance(type, Enum) else _scalar(type)


def _array(type: Value | Bits) -> str:
    real = any(isinstance(item, Quantity) and item.real for _, item in type.items)
    return f"[{'f64' if real else 'i64'}; {len(type.items)}]"


def _scalar(type: Type) -> str:
    if isinstance(type, Octets | Chars):
        return "Vec<u8>" if isinstance(type, Octets) else "String"
    if isinstance(type, Flag):
        return "bool"
    return "f64" if isinstance(type, Quantity) and type.real else "i64"


def _one(found: Iterable[str]) -> str:
    """Return the one type that holds values of all these types."""
    types = list(dict.fromkeys(found))
    if len(types) == 1:
        return types[0]
    if all(each.startswith("[") for each in types):
        return "Vec<f64>" if any("f64" in each for each in types) else "Vec<i64>"
    # An enum counts as a number here; a flag does not.
    if any(each.startswith(("[", "Vec", "String", "bool")) for each in types):
        return "Value"
    return "f64" if "f64" in types else "i64"


class _Shown:
    """A command as the template shows it."""

    def __init__(self, edition: Edition, command: Command) -> None:
        self.command = command
        self.message = type_name(lower.message_class(command.name))
        taken = {other.name for other in edition.commands if other is not command}
        method = command.name.lower()
        method = command.name if method in taken else method
        self.method = f"{method}_" if method in _METHODS else identifier(method)
        fields = {parameter.name: parameter for parameter in parameters(command)}
        shape = _Shape()
        self.arguments = ", ".join(
            f"{identifier(each.name)}: "
            + (shape.argument(fields[each.name]) if each.name in fields else "String")
            for each in arguments(command)
        )
        every = [*fields.values(), *reply_parameters(command)]
        names = dict.fromkeys(parameter.name for parameter in every if parameter.radians)
        self.radians = " ".join(map(identifier, names))
        self.own_result = command.text is not None or len(results(command)) > 1

    @property
    def reply(self) -> str:
        """The type of the result, and the fields that it is made of."""
        found, text, shape = results(self.command), self.command.text, _Shape()
        if text is not None:
            names = [name for name, _ in text.fields]
            return f" -> {type_name(text.class_name)} = {' '.join(map(identifier, names))}"
        if not found or self.command.event:
            return ""
        names = [result.name for result in found]
        made = f"{self.message}Result" if self.own_result else shape.result(found[0])
        return f" -> {made} = {' '.join(map(identifier, names))}"

    @property
    def items(self) -> list[tuple[str, str, str]]:
        """The fields of a result of several parts, or of an event: name, type and description."""
        text, shape = self.command.text, _Shape()
        if text is not None:
            return [(name, "String", doc) for name, doc in text.fields]
        found = reply_parameters(self.command) if self.command.event else results(self.command)
        return [(each.name, shape.result(each), each.doc) for each in found]
