"""Writes a module in Rust for each edition: typed messages for the crate ``cobotwire``.

The template makes the request, the blocking method and the asynchronous method of each command. The
table comes with them as JSON, which the crate reads on first use.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path, PurePosixPath

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Bits,
    Command,
    Edition,
    Listed,
    Type,
    Value,
)
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.render import Files, environment, with_used_types
from cobotwire_codegen.render import python_api as api
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
_TYPES = frozenset(
    {"Async", "From", "Into", "Option", "Result", "Self", "Some", "String", "Typed", "Value", "Vec"}
)
_METHODS = frozenset({"acknowledged", "clone", "open_with", "over"})
# The types of values, by their types in Python.
_SCALARS = {"bool": "bool", "int": "i64", "float": "f64", "bytes": "Vec<u8>", "str": "String"}


def render_rust(edition: Edition, templates: Path | None = None) -> Files:
    """Return the edition's module and its table; ``templates`` replace the shipped ones."""
    jinja = environment(templates)
    jinja.filters.update(rustdoc=rustdoc, rust_name=identifier, camel=camel)
    edition = with_used_types(edition)
    shown = escaped(edition)
    commands = [_Shown(shown, command) for command in shown.commands]
    text = jinja.get_template("rust/edition.rs.j2").render(
        edition=shown,
        name=type_name(shown.class_name),
        commands=commands,
        requests=[each for each in commands if not each.command.event],
        is_of_joints=_is_of_joints,
        array=_array,
        items=_items,
    )
    return {
        PurePosixPath(f"{edition.name}.rs"): text,
        PurePosixPath(f"{edition.name}.json"): edition_json(edition),
    }


def render_every_rust(found: Sequence[Edition]) -> Files:
    """Return the modules of all editions, and the module that lists them, each with its feature."""
    made: Files = {}
    for edition in found:
        made |= render_rust(edition)
    index = environment(None).get_template("rust/mod.rs.j2")
    made[PurePosixPath("mod.rs")] = index.render(editions=found)
    return made


def identifier(name: str) -> str:
    """Return the name of a field or argument in Rust; keywords become raw, or end with ``_``."""
    if name in _NOT_EVEN_RAW:
        return f"{name}_"
    return f"r#{name}" if name in _KEYWORDS else name


def type_name(name: str) -> str:
    """Return the name of a type; ``_`` distinguishes it from names that the module uses."""
    return f"{name}_" if name in _TYPES else name


def camel(name: str) -> str:
    """Return the name of an enum's variant: ``POWER_ON`` gives ``PowerOn``."""
    words = [word[:1] + word[1:].lower() for word in name.split("_")]
    # An underscore between digits stays: 1_2 is not 12.
    joined = re.sub(r"(?<=\d)_(?=\d)", "_", "_".join(words))
    made = re.sub(r"_(?=\D)|(?<=\D)_", "", joined)
    return type_name(made)


def rustdoc(text: str, indent: int = 0) -> str:
    """Return lines of documentation, one for each paragraph of a text that is escaped already."""
    lines = [" ".join(line.split()) for line in text.splitlines() or [""]]
    # Signs that change the direction of text would be an error in a comment.
    safe = ("".join(c if c.isprintable() else "\ufffd" for c in line) for line in lines)
    return "\n".join(f"{' ' * indent}/// {line}".rstrip() for line in safe)


def _argument(parameter: Parameter) -> str:
    """Return the type of an argument; it is optional if a call may leave it out."""
    found = _one(map(_given, parameter.types))
    left_out = parameter.may_be_none or parameter.default is not None
    return f"Option<{found}>" if left_out else found


def _result(parameter: Parameter) -> str:
    """Return the type of a field of a reply."""
    types = parameter.types
    same = len(types) == 1 or not all(isinstance(type, Value) for type in types)
    found = _one(map(_reported if same else _given, types))
    return f"Option<{found}>" if parameter.optional else found


def _given(type: Type) -> str:
    if isinstance(type, Listed):
        return f"Vec<{_given(type.of)}>"
    return _array(type) if type.items else _reported(type)


def _reported(type: Type) -> str:
    """Return the type of a value in a reply."""
    if isinstance(type, Listed):
        return f"Vec<{_reported(type.of)}>"
    if isinstance(type, Value) and _is_of_joints(type):
        return _array(type)
    return type_name(type.class_name) if type.class_name else _SCALARS[type.scalar]


def _is_of_joints(type: Type) -> bool:
    """Return whether the parts of a value type are j1, j2 and so on, so that an array suffices."""
    parts = type.items if isinstance(type, Value) else ()
    return [name for name, _ in parts] == [f"j{n}" for n in range(1, len(parts) + 1)]


def _items(type: Value | Bits) -> list[tuple[str, str, str]]:
    """Return name, type and description of each part of a value type or of bits."""
    return [(name, _reported(item), api.item_doc(item)) for name, item in type.items]


def _array(type: Type) -> str:
    return f"[{_SCALARS[type.scalar]}; {len(type.items)}]"


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
        self.arguments = [
            (each.name, _argument(fields[each.name]) if each.name in fields else "String")
            for each in arguments(command)
        ]
        found, text, reply = results(command), command.text, reply_parameters(command)
        self.radians = list(
            dict.fromkeys(each.name for each in (*fields.values(), *reply) if each.radians)
        )
        self.own_result = text is not None or len(found) > 1
        self.result = f"{self.message}Result" if text is None else type_name(text.class_name)
        shown = reply if command.event else found
        self.items = [(each.name, _result(each), each.doc) for each in shown]
        if text is not None:
            self.items = [(name, "String", doc) for name, doc in text.fields]
        parts = [f"{command.title}.", api.description(command)]
        parts.append("\n".join(f"* {line}" for line in api.argument_lines(command)))
        parts.append(f"Returns: {api.result_line(command)}" if command.awaits_reply else "")
        parts.append(f"Safety: {command.safety}. Command id 0x{command.id:02X}.")
        self.doc = "\n\n".join(filter(None, parts))
        self.reply = self.result if self.own_result else "()"
        if found and not self.own_result:
            self.reply = self.items[0][1]
