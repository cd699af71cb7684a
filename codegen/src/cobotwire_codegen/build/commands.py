"""Nodes of a commands file to a family of commands."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Literal

from cobotwire_codegen.build.types import Types, disputes, stand_in
from cobotwire_codegen.errors import Place, Problem, nearest
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import (
    SAFETY,
    Command,
    Enum,
    Family,
    Field,
    Member,
    Quantity,
    Text,
    Type,
)
from cobotwire_codegen.reader import Reader

_PLACEHOLDER = re.compile(r"\{(\w+)\}")


def build_family(root: Node, types: Types, deadline_ms: int, problems: list[Problem]) -> Family:
    """One commands file."""
    reader = Reader(root, "the commands file", problems)
    commands = [
        _command(name, place, node, types, deadline_ms, problems)
        for name, place, node in reader.entries("commands")
    ]
    family = Family(
        root.place,
        reader.text("family"),
        reader.text("title"),
        reader.text("doc"),
        tuple(commands),
    )
    reader.done()
    return family


def _command(
    name: str, place: Place, node: Node, types: Types, deadline_ms: int, problems: list[Problem]
) -> Command:
    reader = Reader(node, f"the command {name}", problems)
    command = Command(
        place=place,
        id=reader.integer("id"),
        name=name,
        title=reader.text("title"),
        doc=reader.text("doc"),
        safety=reader.one_of("safety", SAFETY),
        source=reader.lines("source"),
        deadline_ms=reader.integer("deadline_ms", deadline_ms),
        request=_fields(reader, "request", types),
        reply=_fields(reader, "reply", types),
        text=_text(reader, problems),
        notes=reader.texts("notes"),
        disputed=disputes(reader),
    )
    reader.done()
    return command


def _fields(reader: Reader, key: str, types: Types) -> tuple[Field, ...]:
    nodes = tuple(reader.items(key))
    if reader.node(key) is not None and not nodes:
        reader.problem("empty-list", f"{key} of {reader.what} is empty: leave the key out")
    plain = [_field(node, key, reader, types) for node in nodes]
    return tuple(
        _selected(field, inner, plain, types) if field.by else field for field, inner in plain
    )


def _field(node: Node, key: str, outer: Reader, types: Types) -> tuple[Field, Reader]:
    reader = Reader(node, f"a field of {outer.what}", outer.problems)
    name = reader.text("name")
    reader.what = f"the field {name} of {outer.what}"
    by = reader.text("by", "")
    echo = _echo(reader) if key == "reply" else ""
    if by:
        type: Type = stand_in(node.place)
    else:
        where = reader.required("is")
        type = stand_in(node.place) if where is None else types.find(reader.text("is"), where.place)
    narrowed = reader.range("range")
    if narrowed is not None:
        if isinstance(type, Quantity):
            type = replace(type, range=narrowed)
        else:
            reader.problem("bad-range", f"{reader.what} is no quantity: it takes no range")
    doc = reader.text("doc", "") or type.doc
    field = Field(node.place, name, type, doc, echo, by, ())
    if not by:
        reader.done()
    return field, reader


def _echo(reader: Reader) -> Literal["", "required", "optional"]:
    word = reader.one_of("echo", ("required", "optional"), "")
    if word == "required":
        return "required"
    return "optional" if word == "optional" else ""


def _selected(
    field: Field, reader: Reader, plain: list[tuple[Field, Reader]], types: Types
) -> Field:
    """Give a field that another one decides its cases, one for each member of that enum."""
    selector = next((other for other, _ in plain if other.name == field.by), None)
    members: dict[str, Member] = {}
    if selector is None or not isinstance(selector.type, Enum) or selector.by:
        reader.problem("bad-selector", f"by: {field.by} must name an enum field of the message")
    else:
        members = {member.name: member for member in selector.type.members}
    cases: list[tuple[Member, Type]] = []
    for name, place, node in reader.entries("cases"):
        inner = Reader(node, f"the case {name} of {reader.what}", reader.problems)
        type = types.find(inner.text("is"), node.place)
        inner.done()
        if name in members:
            cases.append((members.pop(name), type))
        elif selector is not None:
            reader.problem("unknown-case", f"{name} is no open case{nearest(name, members)}", place)
    for name in members:
        reader.problem("missing-case", f"{reader.what} has no case for {name}")
    reader.done()
    first = cases[0][1] if cases else field.type
    return replace(field, type=first, doc=field.doc or first.doc, cases=tuple(cases))


def _text(outer: Reader, problems: list[Problem]) -> Text | None:
    node = outer.node("reply_text")
    if node is None:
        return None
    reader = Reader(node, f"the text reply of {outer.what}", problems)
    pieces = _PLACEHOLDER.split(reader.text("text"))
    docs: dict[str, str] = {}
    for item in reader.items("fields"):
        inner = Reader(item, f"a field of {reader.what}", problems)
        docs[inner.text("name")] = inner.text("doc")
        inner.done()
    names = pieces[1::2]
    if names != list(docs) or pieces[-1] or not all(pieces[0:-1:2]):
        reader.problem(
            "bad-text", "the text must be `word {field}` in turn, with the fields as listed"
        )
    text = Text(
        node.place,
        reader.text("class"),
        tuple(pieces[0:-1:2]),
        tuple(docs.items()),
        reader.integer("silence_ms"),
    )
    reader.done()
    return text
