"""Writes a module in JavaScript for each edition, and its types: a client for the npm package.

The module has the table as JSON, and a row for each method: its command, arguments and results. The
package makes the methods from these rows; the types of the module describe them.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Command,
    Edition,
    Listed,
    Type,
)
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.render import Files, environment, with_used_types
from cobotwire_codegen.render.arguments import arguments
from cobotwire_codegen.render.escape_markdown import escaped
from cobotwire_codegen.render.parameters import Parameter, parameters, reply_parameters, results

# The types that annotations use without an import, and the names that the module imports.
_TYPES = frozenset({"Client", "EventStream", "Promise", "Uint8Array", "describe", "table"})
# The methods and attributes of every client, and `then`, which would make it a promise.
_METHODS = frozenset(
    {"acknowledged", "at", "call", "close", "constructor", "events", "stream", "then", "withSignal"}
    | {"description", "line", "perform", "settings", "with"}
)
# The types of values, by their types in Python.
_SCALARS = {
    "bool": "boolean",
    "int": "number",
    "float": "number",
    "bytes": "Uint8Array",
    "str": "string",
}
# Names that an argument cannot have.
_WORDS = """
    arguments await break case catch class const continue debugger default delete do else enum eval
    export extends false finally for function if implements import in instanceof interface let new
    null package private protected public return static super switch this throw true try typeof var
    void while with yield
"""
_KEYWORDS = frozenset(_WORDS.split())
# Keys for people or simulators. Clients do not read them; without them a module is smaller.
_WORDS_OF_OTHERS = """
    agrees_with changes disputed doc document encoders error_codes families firmware gripper
    joint_limits lines motion notes place samples servos title
"""
_FOR_OTHERS = frozenset(_WORDS_OF_OTHERS.split())


def render_typescript(edition: Edition, templates: Path | None = None) -> Files:
    """Return the module of an edition and its types; ``templates`` replace the shipped ones."""
    return _rendered(edition, templates, "cobotwire")


def render_every_typescript(found: Sequence[Edition]) -> Files:
    """Return the modules of all editions, as the package contains them."""
    made: Files = {}
    for edition in found:
        made |= _rendered(edition, None, "../dist/index.js")
    return made


def _rendered(edition: Edition, templates: Path | None, package: str) -> Files:
    jinja = environment(templates)
    jinja.filters.update(tsdoc=tsdoc, camel=camel, literal=literal, type_name=type_name)
    shown = escaped(with_used_types(edition))
    taken: set[str] = set()
    common = {
        "edition": shown,
        "package": package,
        "name": type_name(shown.class_name),
        "table": literal(_for_clients(json.loads(edition_json(edition)))),
        "commands": [_Shown(command, taken) for command in shown.commands],
        "item": _reported,
    }
    return {
        PurePosixPath(f"{edition.name}{end}"): jinja.get_template(
            f"typescript/edition{end}.j2"
        ).render(common)
        for end in (".js", ".d.ts")
    }


def _for_clients(value: Any) -> Any:
    """Return a part of a table without the keys that clients do not read.

    Effects are kept whole, because their keys can be names of states.
    """
    if isinstance(value, list):
        return [_for_clients(each) for each in value]
    if not isinstance(value, dict):
        return value
    kept = ((key, each) for key, each in value.items() if key not in _FOR_OTHERS)
    return {key: each if key == "effect" else _for_clients(each) for key, each in kept}


def camel(name: str) -> str:
    """Return a name as JavaScript writes it: ``get_angles`` gives ``getAngles``."""
    return re.sub(r"(?<=[^_])_([a-z])", lambda found: found[1].upper(), name)


def type_name(name: str) -> str:
    """Return the name of a type; ``_`` distinguishes it from names that the module uses."""
    return f"{name}_" if name in _TYPES else name


def literal(value: Any) -> str:
    """Return a value as an expression of JavaScript; a text may have ``</script>`` in it."""
    return json.dumps(value, separators=(",", ":")).replace("</", "<\\/")


def tsdoc(text: str, indent: int = 0) -> str:
    """Return a comment with the paragraphs of a text that is escaped already."""
    lines = (" ".join(line.split()) for line in text.splitlines() or [""])
    safe = ("".join(c if c.isprintable() else "\ufffd" for c in line) for line in lines)
    inner = f"\n{' ' * indent} * ".join(line.replace("*/", "*\\/") for line in safe)
    return f"{' ' * indent}/** {inner} */"


def _reported(type: Type) -> str:
    """Return the type of a value in a reply."""
    if isinstance(type, Listed):
        return f"{_reported(type.of)}[]"
    return type_name(type.class_name) if type.class_name else _SCALARS[type.scalar]


def _given(type: Type) -> str:
    """Return the type of an argument."""
    if type.items:
        return "readonly number[]"
    if isinstance(type, Listed):
        return f"readonly ({_given(type.of)})[]"
    return _reported(type)


def _union(types: Iterable[str]) -> str:
    return " | ".join(dict.fromkeys(types))


def _result(parameter: Parameter, *, optional: bool = False) -> str:
    absent = ["undefined"] if parameter.optional or optional else []
    return _union([*map(_reported, parameter.types), *absent])


class _Shown:
    """A command as the templates show it; ``taken`` are the names of the methods before it."""

    def __init__(self, command: Command, taken: set[str]) -> None:
        self.command = command
        message = lower.message_class(command.name)
        method = camel(command.name)
        method = command.name if method in taken else method
        self.method = f"{method}_" if method in _METHODS else method
        taken.add(self.method)
        self.event = type_name(message)
        text = command.text
        self.several = type_name(text.class_name if text else f"{message}Result")
        self._found = reply_parameters(command) if command.event else results(command)
        self._single = not text and not command.event and len(self._found) == 1

    @property
    def items(self) -> list[tuple[str, str, str]]:
        """The fields of a result of several parts, or of an event: name, type and description."""
        if self.command.text is not None:
            return [(name, "string", doc) for name, doc in self.command.text.fields]
        return [] if self._single else [(p.name, _result(p), p.doc) for p in self._found]

    @property
    def returns(self) -> str:
        """The type of the result."""
        if self._single:
            return _result(self._found[0])
        return self.several if self.items else "void"

    @property
    def signature(self) -> str:
        """The arguments with their types; those that a call may leave out are the last ones."""
        fields = {parameter.name: parameter for parameter in parameters(self.command)}
        shown: list[str] = []
        left_out = True
        for each in reversed(arguments(self.command)):
            parameter = fields.get(each.name)
            type = _union(map(_given, parameter.types)) if parameter else "string"
            optional = bool(each.default)
            left_out = left_out and optional
            name = f"{camel(each.name)}_" if each.name in _KEYWORDS else camel(each.name)
            absent = " | undefined" if optional and not left_out else ""
            shown.append(f"{name}{'?' * left_out}: {type}{absent}")
        return ", ".join(reversed(shown))

    @property
    def row(self) -> list[Any]:
        """What the package makes the method from; see ``Row`` in its ``client.ts``."""
        named = {camel(name): name for name, _, _ in self.items}
        every = [*parameters(self.command), *self._found]
        radians = list(dict.fromkeys(each.name for each in every if each.radians))
        flags = [each.name for each in self._found if all(map(_is_flag, each.types))]
        given = [each.name for each in arguments(self.command)]
        result = self._found[0].name if self._single else named
        row = [self.command.name, given, result, radians, flags]
        while row[-1] in ([], {}):
            row.pop()
        return row


def _is_flag(type: Type) -> bool:
    return type.scalar == "bool"
