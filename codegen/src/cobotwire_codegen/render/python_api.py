"""What the Python client's templates need: signatures, bodies, docstrings, imports."""

from __future__ import annotations

import textwrap

from cobotwire_codegen.model import Command, Edition, Enum, Family, Value
from cobotwire_codegen.render.parameters import (
    Parameter,
    argument_expression,
    argument_type,
    parameters,
    result_expression,
    result_type,
    results,
)
from cobotwire_codegen.render.way import BLOCKING, Way

WIDTH = 100
ACK_DOC = (
    "ack_within: Seconds to wait for the acknowledgement. Left out: the call returns when its "
    "bytes are written."
)


def returns(command: Command) -> str:
    """The type of the result."""
    found = results(command)
    if command.text is not None:
        return command.text.class_name
    if not found:
        return "None"
    return result_type(found[0]) if len(found) == 1 else result_class(command)


def result_class(command: Command) -> str:
    """The named tuple of a reply with several results."""
    return "".join(word.capitalize() for word in command.name.split("_")) + "Reply"


def answer(command: Command) -> str:
    """The expression that makes the whole result out of the reply."""
    if command.text is not None:
        names = ", ".join(f'reply["{name}"]' for name, _ in command.text.fields)
        return f"{command.text.class_name}({names})"
    found = results(command)
    if len(found) == 1:
        return result_expression(found[0])
    return f"{result_class(command)}({', '.join(map(result_expression, found))})"


def signature(command: Command, way: Way = BLOCKING) -> str:
    """The method's head, laid out as ruff lays it out."""
    parts = ["self"]
    for parameter in parameters(command):
        default = " = None" if parameter.optional else ""
        parts.append(f"{parameter.name}: {argument_type(parameter)}{default}")
    if command.request_text is not None:
        parts.extend(f"{name}: str" for name, _ in command.request_text.fields)
    if command.ack:
        parts.extend(("*", "ack_within: float | None = None"))
    head = f"{way.async_}def {command.name}("
    return _laid_out(head, parts, f") -> {returns(command)}:", 4)


def _laid_out(head: str, parts: list[str], tail: str, indent: int) -> str:
    """``head parts tail`` on one line, or on three, or a line each, as ruff lays it out."""
    joined = ", ".join(parts)
    margin = " " * indent
    if indent + len(head) + len(joined) + len(tail) <= WIDTH:
        return f"{head}{joined}{tail}"
    if indent + 4 + len(joined) <= WIDTH:
        return f"{head}\n{margin}    {joined}\n{margin}{tail}"
    lines = "".join(f"{margin}    {part},\n" for part in parts)
    return f"{head}\n{lines}{margin}{tail}"


def call(command: Command, way: Way = BLOCKING) -> str:
    """The driver's own call, with its arguments."""
    longest = max(command.requests, key=len)
    known = {parameter.name: parameter for parameter in parameters(command)}
    values = [
        argument_expression(known[field.name]) if field.name in known else str(field.const)
        for field in longest
    ]
    row = f"({values[0]},)" if len(values) == 1 else f"({', '.join(values)})"
    if any(parameter.optional for parameter in known.values()):
        row = f"given{row}" if len(values) > 1 else f"given({values[0]})"
    arguments = [f'"{command.name}"', row]
    if command.request_text is not None:
        pairs = ", ".join(f'"{name}": {name}' for name, _ in command.request_text.fields)
        arguments.append(f"{{{pairs}}}")
    if command.ack:
        arguments.append("ack_within=ack_within")
    head = "reply = " if command.answers else ""
    method = "_ask" if command.answers else "_tell"
    return _laid_out(f"{head}{way.await_}self.{method}(", arguments, ")", 8)


def escaped(text: str) -> str:
    """Text that may stand in a docstring, also right before its end."""
    text = text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    return f'{text[:-1]}\\"' if text.endswith('"') else text


def docstring(text: str, indent: int) -> str:
    """A docstring of one paragraph, on one line if it fits."""
    text = escaped(text)
    flat = f'{" " * indent}"""{text}"""'
    if len(flat) <= WIDTH:
        return flat
    opened = _filled(f'"""{text}', indent, 0)
    return f'{opened}\n{" " * indent}"""'


def wrapped(text: str, indent: int, hanging: int = 0) -> str:
    """A paragraph of a docstring; further lines stand ``hanging`` deeper."""
    return _filled(escaped(text), indent, hanging)


def _filled(text: str, indent: int, hanging: int) -> str:
    return textwrap.fill(
        text,
        WIDTH,
        initial_indent=" " * indent,
        subsequent_indent=" " * (indent + hanging),
        break_long_words=False,
        break_on_hyphens=False,
    )


def argument_doc(parameter: Parameter) -> str:
    """An argument's line in the docstring."""
    shown = " Given in radians; on the wire:" if parameter.radians else " Allowed:"
    left_out = " May be left out." if parameter.optional else ""
    return f"{parameter.name}: {parameter.doc}{shown} {parameter.allowed}.{left_out}"


def helpers(family: Family) -> list[str]:
    """The functions of the package that a family's methods call."""
    names = set()
    for command in family.commands:
        if any(parameter.optional for parameter in parameters(command)):
            names.add("given")
        if any(parameter.radians for parameter in parameters(command)):
            names.add("to_degrees")
        if any(parameter.radians for parameter in results(command)):
            names.add("to_radians")
    return sorted(names)


def imports(family: Family) -> tuple[list[str], list[str], bool]:
    """What a family's methods need: enums, value classes, and whether Sequence."""
    enums: set[str] = set()
    values: set[str] = set()
    sequence = False
    for command in family.commands:
        for parameter in parameters(command):
            sequence = sequence or any(isinstance(type, Value) for type in parameter.types)
            enums |= {type.class_name for type in parameter.types if isinstance(type, Enum)}
        found = results(command)
        if command.text is not None or len(found) > 1:
            values.add(returns(command))
        for parameter in found:
            kind = result_type(parameter)
            enums |= {t.class_name for t in parameter.types if isinstance(t, Enum)} & {kind}
            values |= {t.class_name for t in parameter.types if isinstance(t, Value)} & {kind}
    return sorted(enums), sorted(values), sequence


def moves(edition: Edition) -> bool:
    """Whether the edition has every command that it takes to wait for the end of a motion."""
    needed = {"joint targets", "coordinate targets", "reached", "moving", "stop"}
    return needed <= {command.role for command in edition.commands}


def value_classes(edition: Edition) -> list[str]:
    """Every named tuple of an edition."""
    names = {type.class_name for type in edition.types if isinstance(type, Value)}
    for command in edition.commands:
        if command.text is not None or len(results(command)) > 1:
            names.add(returns(command))
    return sorted(names)


def replies_need_enums(edition: Edition) -> list[str]:
    """The enums that stand in replies with several results."""
    found = [p for c in edition.commands if len(results(c)) > 1 for p in results(c)]
    types = {type for parameter in found for type in parameter.types}
    return sorted(type.class_name for type in types if isinstance(type, Enum))


def capitalize_first(text: str) -> str:
    """A sentence's first letter, without touching the others."""
    return text[:1].upper() + text[1:]


def oneline(text: str) -> str:
    """A signature on one line."""
    flat = " ".join(text.split()).replace("( ", "(").replace(", )", ")").replace(" )", ")")
    return (
        flat.removeprefix("def ").removesuffix(":").replace("(self, ", "(").replace("(self)", "()")
    )
