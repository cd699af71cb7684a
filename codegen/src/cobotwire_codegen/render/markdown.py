"""Prepares the Markdown reference: byte tables, example frames, errata."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Change,
    Command,
    Dispute,
    Edition,
    Erratum,
    Field,
    Quantity,
    Text,
    Type,
    Value,
    Vector,
)
from cobotwire_codegen.model.shapes import Shaped
from cobotwire_codegen.render.arguments import constant_in_words, default_in_words
from cobotwire_codegen.render.escape_markdown import code as code
from cobotwire_codegen.render.words import decimal, units


def robot(edition: Edition) -> str:
    """Return the robot's name: the edition's title without its article and its subtitle."""
    return re.sub("^(A|An|The) ", "", edition.title.partition(":")[0])


def wire_encoding(type: Type) -> str:
    """Return how a type is encoded, in words."""
    if isinstance(type, Shaped):
        return type.span
    if isinstance(type, Value):
        return ", ".join(wire_encoding(item) for _, item in type.items)
    if not isinstance(type, Quantity):
        return type.wire.name
    if type.choices:
        return f"{type.wire.name}, one of {', '.join(map(str, type.choices))}"
    if type.scale == 1:
        return f"{type.wire.name}, {units(type.unit)}" if type.unit else type.wire.name
    times = decimal(Fraction(1) / type.scale)
    return f"{type.wire.name}, {units(type.unit) if type.unit else 'value'} x {times}"


def text_vector(edition: Edition, command: Command) -> Vector | None:
    """Return the vector of a text reply, if there is one."""
    fitting = (vector for vector in edition.vectors if vector.command == command.name)
    return next((vector for vector in fitting if vector.text is not None), None)


def values_in_words(vector: Vector) -> str:
    """Return a vector's values in words."""
    return ", ".join(f"{name} = {_value(value)}" for name, value in vector.values)


def _value(value: object) -> str:
    if isinstance(value, tuple):
        return "(" + ", ".join(_value(item) for item in value) + ")"
    return decimal(value) if isinstance(value, Fraction) else str(value)


def hexed(data: bytes) -> str:
    """Return bytes as the document prints them."""
    return data.hex(" ").upper()


def errata(edition: Edition, command: Command) -> list[Erratum]:
    """Return the errata of a command."""
    return [erratum for erratum in edition.errata if command.name in erratum.commands]


def general_errata(edition: Edition) -> list[Erratum]:
    """Return the errata of the transport and the frame."""
    return [erratum for erratum in edition.errata if not erratum.commands]


def disputed_types(edition: Edition, command: Command) -> list[Quantity]:
    """Return the quantities of a command that are disputed themselves."""
    found: dict[str, Quantity] = {}
    for field in command.fields:
        for _, type in lower.cases(field):
            items = [item for _, item in type.items] if isinstance(type, Value) else [type]
            for item in items:
                if isinstance(item, Quantity) and item.disputed:
                    found[item.name] = item
    return list(found.values())


def encoding(field: Field) -> str:
    """Return how a field is encoded, each number format and scale once."""
    found = []
    for _, type in lower.cases(field):
        items = [item for _, item in type.items] if isinstance(type, Value) else [type]
        found += [wire_encoding(item) for item in items]
    return "; ".join(dict.fromkeys(found))


def acknowledgements(edition: Edition) -> list[Field]:
    """Return the fields of the acknowledgements of all commands, each once."""
    fields = [f for c in edition.commands if c.ack for variant in c.replies for f in variant]
    return list({(field.name, field_doc(field)): field for field in fields}.values())


def disputes(edition: Edition, command: Command) -> list[Dispute]:
    """Return the disputes about a command and about the quantities that it carries."""
    types = disputed_types(edition, command)
    return [*command.disputed, *(each for type in types for each in type.disputed)]


def source_words(
    edition: Edition,
    disputes: Sequence[Dispute],
    changes: Sequence[Change],
    errata: Sequence[Erratum],
    derived: Sequence[Vector],
) -> str:
    """Return the summary line under which the sources of a command are folded."""
    mistakes = "1 mistake" if len(errata) == 1 else f"{len(errata)} mistakes"
    parts = (
        (
            disputes,
            "disputed: " + "1 fact" if len(disputes) == 1 else f"disputed: {len(disputes)} facts",
        ),
        (changes, f"differs from {edition.base}"),
        (errata, f"{mistakes} in the document"),
        (derived, "where the example comes from"),
    )
    return "; ".join(text for found, text in parts if found)


def linked(text: str) -> str:
    """Return an escaped text with links in place of its addresses."""
    return re.sub(r"https://[\w./#-]*[\w/]", lambda match: f"<{match[0]}>", text)


def field_rows(command: Command) -> list[tuple[str, Field]]:
    """Return the fields of every variant, each once, with their direction.

    Fields of acknowledgements are left out: they are described once for the edition.
    """
    replies = () if command.ack else command.replies
    rows = [("request", field) for variant in command.requests for field in variant]
    rows += [("reply", field) for variant in replies for field in variant]
    seen: dict[tuple[str, str, Type], tuple[str, Field]] = {}
    for direction, field in rows:
        seen.setdefault((direction, field.name, field.type), (direction, field))
    return list(seen.values())


def field_doc(field: Field) -> str:
    """Return the description of a field, with echo, optional and constant."""
    words = [field.doc]
    if field.echo:
        older = "; older firmware leaves it out" if field.echo == "optional" else ""
        words.append(f"Repeats the request's value{older}.")
    if field.optional:
        words.append("May be left out.")
    if field.counts:
        words.append(f"Counts the elements of `{field.counts}`.")
    if field.const is not None:
        words.append(f"Always {constant_in_words(field)}.")
    if field.default is not None:
        words.append(f"Left out: {default_in_words(field)}.")
    return " ".join(words)


def pattern(text: Text) -> str:
    """Return text outside a frame, with its fields in angle brackets."""
    pairs = zip(text.prefixes, text.fields)
    return "".join(f"{prefix}<{name}>" for prefix, (name, _) in pairs) + text.suffix


def reply_note(command: Command) -> str:
    """Return the note on a further variant of a reply."""
    older = any(field.echo == "optional" for field in command.reply)
    return "older firmware" if older else "another variant"
