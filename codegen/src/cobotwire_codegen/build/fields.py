"""The fields of a message, and the forms that it can have."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from cobotwire_codegen.build.types import Types, stand_in
from cobotwire_codegen.errors import nearest
from cobotwire_codegen.load import Node, Sequence
from cobotwire_codegen.model import Enum, Field, Form, Member, Quantity, Type, Value
from cobotwire_codegen.reader import Reader

# A field that picks cases has so few values that they can be listed.
MOST_CASES = 64


def build_forms(reader: Reader, key: str, types: Types) -> tuple[Form, ...]:
    """The forms of a message, the full one first; none where the command does not give it."""
    listed = list(reader.items(f"{key}_forms"))
    plain = reader.node(key)
    if listed and plain is not None:
        reader.problem("two-forms", f"{reader.what} gives both {key} and {key}_forms")
    forms = []
    for node in listed:
        if isinstance(node, Sequence):
            forms.append(_form(node.items, key, reader, types))
        else:
            reader.problem("wrong-kind", f"{key}_forms must list lists of fields", node.place)
    if forms:
        return tuple(forms)
    nodes = tuple(reader.items(key))
    if plain is not None and not nodes:
        reader.problem("empty-list", f"{key} of {reader.what} is empty: leave the key out")
    return _shorter(_form(nodes, key, reader, types), reader) if nodes else ()


def _shorter(full: Form, reader: Reader) -> tuple[Form, ...]:
    """The full form, and what is left when optional fields are left out."""
    forms = [full]
    while forms[-1] and forms[-1][-1].optional:
        forms.append(forms[-1][:-1])
    if any(field.optional for field in forms[-1]):
        reader.problem("bad-optional", f"{reader.what}: only the last fields can be optional")
    without = tuple(field for field in full if field.echo != "optional")
    if without != full:
        forms.append(without)
    return tuple(forms)


def _form(nodes: tuple[Node, ...], key: str, outer: Reader, types: Types) -> Form:
    plain = [_read(node, key, outer, types) for node in nodes]
    return tuple(_selected(field, inner, plain, types) for field, inner in plain)


def build_field(node: Node, key: str, outer: Reader, types: Types) -> Field:
    """One field that no other one decides."""
    [field] = _form((node,), key, outer, types)
    return field


def _read(node: Node, key: str, outer: Reader, types: Types) -> tuple[Field, Reader]:
    reader = Reader(node, f"a field of {outer.what}", outer.problems)
    name = reader.text("name")
    reader.what = f"the field {name} of {outer.what}"
    by = reader.text("by", "")
    type: Type = stand_in(node.place)
    if not by:
        where = reader.required("is")
        if where is not None:
            type = types.find(reader.text("is"), where.place)
    narrowed = reader.range("range")
    if narrowed is not None and not by and isinstance(type, Quantity):
        lowest, highest = (bound * type.scale for bound in type.bounds)
        if narrowed[0] < lowest or narrowed[1] > highest or type.choices:
            message = f"the range of {reader.what} is not inside that of its type {type.name}"
            reader.problem("bad-range", message)
        type = replace(type, range=narrowed)
    if narrowed is not None and (by or not isinstance(type, Quantity)):
        reader.problem("bad-range", f"{reader.what} is no quantity: it takes no range")
    field = Field(
        place=node.place,
        name=name,
        type=type,
        doc=reader.text("doc", "") or type.doc,
        echo=_echo(reader) if key == "reply" else "",
        optional=reader.yes("optional"),
        const=_const(reader, type),
        by=by,
        cases=(),
    )
    return field, reader


def _echo(reader: Reader) -> Literal["", "required", "optional"]:
    word = reader.one_of("echo", ("required", "optional"), "")
    if word == "required":
        return "required"
    return "optional" if word == "optional" else ""


def _const(reader: Reader, type: Type) -> int | None:
    if reader.node("const") is None:
        return None
    value = reader.integer("const")
    if isinstance(type, Value) or not type.wire.minimum <= value <= type.wire.maximum:
        reader.problem("bad-const", f"{reader.what} cannot always be {value}")
        return None
    return value


def _selected(
    field: Field, reader: Reader, plain: list[tuple[Field, Reader]], types: Types
) -> Field:
    """Give a field that another one decides its cases, one for each value of that field."""
    if not field.by:
        reader.done()
        return field
    selector = next((other for other, _ in plain if other.name == field.by), None)
    members = _values(selector)
    if not members:
        message = f"by: {field.by} must name a field of the message with few values"
        reader.problem("bad-selector", message)
    cases: list[tuple[Member, Type]] = []
    for name, place, node in reader.entries("cases"):
        inner = Reader(node, f"the case {name} of {reader.what}", reader.problems)
        type = types.find(inner.text("is"), node.place)
        inner.done()
        if name in members:
            cases.append((members.pop(name), type))
        elif selector is not None:
            hint = nearest(name, members)
            reader.problem("unknown-case", f"{name} is no open case{hint}", place)
    for name in members:
        reader.problem("missing-case", f"{reader.what} has no case for {name}")
    reader.done()
    first = cases[0][1] if cases else field.type
    return replace(field, type=first, doc=field.doc or first.doc, cases=tuple(cases))


def _values(selector: Field | None) -> dict[str, Member]:
    """The values of a field that picks cases, by the names that the cases use."""
    if selector is None or selector.by:
        return {}
    if isinstance(selector.type, Enum):
        return {member.name: member for member in selector.type.members}
    if not isinstance(selector.type, Quantity) or selector.type.scale != 1:
        return {}
    lowest, highest = (int(bound) for bound in selector.type.bounds)
    numbers = selector.type.choices or range(lowest, highest + 1)
    if len(numbers) > MOST_CASES:
        return {}
    return {str(n): Member(selector.place, str(n), n, "") for n in numbers}
