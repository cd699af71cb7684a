"""Prepares the text of the Python package: signatures, calls, docstrings, imports."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from cobotwire_codegen.lower import message_class
from cobotwire_codegen.model import (
    Bits,
    Command,
    Edition,
    Enum,
    Family,
    Flag,
    Listed,
    Quantity,
    Value,
)
from cobotwire_codegen.render.arguments import Argument, arguments, overloads
from cobotwire_codegen.render.layout import WIDTH, laid_out, oneline
from cobotwire_codegen.render.messages import classes_in_method, declared
from cobotwire_codegen.render.parameters import Parameter, results, returns
from cobotwire_codegen.render.words import units

# Word stems that add nothing to a docstring.
_WORDS = "a all an and arm as at by each every for from given in is it of on one or the their to"
_VERBS = "check get mov read report return send set switch whether"
FILLING = frozenset(f"{_WORDS} {_VERBS}".split())
# The notes of commands of these safety classes are warnings, so the docstring keeps them.
WARNED = ("motion", "power", "persistent write")
_PARTS = re.compile(r"\A\d+ numbers \(([^()]*)\)\Z")
_SENTENCE = re.compile(r"(?<=[.])\s+(?=[A-Z])")


def signature(command: Command) -> str:
    """Return the head of a command's method."""
    return _head(command, arguments(command), ":")


def overload_signatures(command: Command) -> list[str]:
    """Return the heads of a method's overloads, one for each variant; none if it has none."""
    return [_head(command, variant, ": ...") for variant in overloads(command)]


def signatures(command: Command) -> list[str]:
    """Return every form of a method's call, one on each line; for an event, its class."""
    if command.event:
        return [message_class(command.name)]
    heads = overload_signatures(command) or [signature(command)]
    return [oneline(head.removesuffix(" ...")) for head in heads]


def _head(command: Command, given: tuple[Argument, ...], end: str) -> str:
    parts = declared(command, given)
    if command.ack:
        parts += [*([] if "*" in parts else ["*"]), "ack_within: float | None = None"]
    return laid_out(f"def {command.name}(", parts, f") -> {returns(command)}{end}", 4)


def call(command: Command, family: Family) -> str:
    """Return the body of a command's method."""
    given = [argument.name for argument in arguments(command)]
    head = f"return self.{'_call' if command.awaits_reply else '_send'}("
    # The constructor of a request with overloads accepts only the arguments of one overload.
    made = "._of" if overloads(command) else ""
    opening = f"messages.{family.name}.{message_class(command.name)}{made}("
    request = f"{opening}{', '.join(given)})"
    if 12 + len(request) + len(",") > WIDTH:
        request = laid_out(opening, given, ")", 12)
    return laid_out(head, [request, "ack_within"] if command.ack else [request], ")", 8)


def description(command: Command) -> str:
    """Return the first sentence if it adds a word to the rest of the docstring, and the warnings.

    The reference page has the whole description and every note.
    """
    sentence = _SENTENCE.split(command.doc, maxsplit=1)[0]
    rest = " ".join([command.title, *argument_lines(command), result_line(command)])
    new = _stems(sentence) - _stems(rest) - FILLING
    warnings = command.notes if command.safety in WARNED else ()
    return " ".join([*([sentence] if new else []), *warnings])


def _stems(text: str) -> set[str]:
    words = "".join(c if c.isalnum() else " " for c in text.lower()).split()
    return {word.removesuffix("s").removesuffix("e") for word in words} | set(words) & FILLING


def argument_lines(command: Command) -> list[str]:
    """Return a line of the docstring for each argument, with its range and unit."""
    return [argument.doc for argument in arguments(command)]


def result_line(command: Command) -> str:
    """Return the line of the docstring that describes the result."""
    if command.text is not None:
        return "; ".join(_clause(doc) for _, doc in command.text.fields) + "."
    shown = [(result, _brief(result)) for result in results(command)]
    return (
        "; ".join(_clause(r.doc) + (f" ({allowed})" if allowed else "") for r, allowed in shown)
        + "."
    )


def _brief(parameter: Parameter) -> str:
    """Return the allowed values without what the annotation shows: flags, the number of parts."""
    if all(isinstance(type, Flag) for type in parameter.types):
        return ""
    return _PARTS.sub(r"\1", parameter.allowed)


def _clause(sentence: str) -> str:
    return sentence.removesuffix(".")


def item_docs(value: Value | Bits) -> list[tuple[str, str]]:
    """Return the parts of a named tuple with their docs; neighbours with equal docs are joined."""
    found: list[tuple[str, str]] = []
    for name, item in value.items:
        doc = item_doc(item)
        if found and found[-1][1] == doc:
            found[-1] = (f"{found[-1][0]}, {name}", doc)
        else:
            found.append((name, doc))
    return found


def item_doc(item: Quantity | Enum | Flag) -> str:
    """Return the description of a part of a named tuple, with its unit."""
    radians = isinstance(item, Quantity) and item.radians
    return item.doc + (f" In {units(item.unit)}." if item.unit and not radians else "")


def derived(name: str, function: str, owner: str) -> str:
    """Return the line of a class body that derives a method from another class's method."""
    return laid_out(f"{name} = {function}(", [f"{owner}.{name}"], ")", 4)


def family_class(family: Family) -> str:
    """Return the name of the class of a family's methods."""
    return f"{family.name.capitalize()}Commands"


def imports(methods: Sequence[Command]) -> tuple[set[str], bool]:
    """Return the enums and named tuples that methods name, and whether they use Sequence."""
    used = set().union(*map(classes_in_method, methods))
    found = (argument for command in methods for argument in arguments(command))
    return used, any("Sequence[" in argument.annotation for argument in found)


def overloaded(methods: Sequence[Command]) -> bool:
    """Return whether a method has several signatures."""
    return any(map(overloads, methods))


def methods(commands: Sequence[Command]) -> list[Command]:
    """Return the commands that become methods: all but the events."""
    return [command for command in commands if not command.event]


def method(command: Command) -> Any:
    """Return all that the template of a family shows of a command's method."""
    return (
        signature(command),
        overload_signatures(command),
        command.title,
        description(command),
        argument_lines(command),
        result_line(command),
        command.safety,
        command.id,
    )


def moves(edition: Edition) -> bool:
    """Return whether the edition has every command that waiting for a motion's end needs."""
    roles = {command.role for command in edition.commands}
    return "joint targets" in roles and bool(roles & {"reached", "joints"})


def value_classes(edition: Edition) -> list[str]:
    """Return the name of every named tuple of an edition."""
    names = {type.class_name for type in edition.types if isinstance(type, Value | Bits)}
    for command in edition.commands:
        if command.text is not None or len(results(command)) > 1:
            names.add(returns(command))
    return sorted(names)


def enum_classes(edition: Edition) -> list[str]:
    """Return the name of every enum of an edition."""
    return sorted({type.class_name for type in edition.types if isinstance(type, Enum)})


def enums_in_values(edition: Edition) -> list[str]:
    """Return the enums that occur in replies with several results."""
    found = [p for c in edition.commands if len(results(c)) > 1 for p in results(c)]
    types = {type for parameter in found for type in parameter.types}
    types |= {type.of for type in types if isinstance(type, Listed)}
    types |= {part for type in edition.types if isinstance(type, Bits) for _, part in type.items}
    return sorted({type.class_name for type in types if isinstance(type, Enum)})
