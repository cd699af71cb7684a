"""Builds the fields of a message, and its variants."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from cobotwire_codegen import language
from cobotwire_codegen.build.types import Types, stand_in
from cobotwire_codegen.build.vectors import plain_value
from cobotwire_codegen.errors import nearest
from cobotwire_codegen.load import Node, Sequence
from cobotwire_codegen.model import Field, Member, Quantity, Type, Variant
from cobotwire_codegen.reader import Reader, label
from cobotwire_codegen.wire import raw_values

Direction = Literal["request", "reply"]
# The largest number of values of a selector, since its cases list each value.
MOST_CASES = 64
_KEYS = {
    "request": (language.Command.request, language.Command.request_variants),
    "reply": (language.Command.reply, language.Command.reply_variants),
}


def build_variants(reader: Reader, direction: Direction, types: Types) -> tuple[Variant, ...]:
    """Return the variants of a message, the full one first; none if the command has no message."""
    plain, several = _KEYS[direction]
    listed, fields = reader.get(several), reader.get(plain)
    if listed and reader.node(plain) is not None:
        message = f"{reader.what} gives both {plain.name} and {several.name}; keep one of them"
        reader.problem("fields-and-variants", message)
    if listed:
        inner = [node.items for node in listed if isinstance(node, Sequence)]
        return tuple(_variant(nodes, direction, reader, types) for nodes in inner)
    return _shorter(_variant(fields, direction, reader, types), reader) if fields else ()


def _shorter(full: Variant, reader: Reader) -> tuple[Variant, ...]:
    """Return the full variant, and the variants without optional fields."""
    variants = [full]
    while variants[-1] and variants[-1][-1].optional:
        variants.append(variants[-1][:-1])
    if any(field.optional for field in variants[-1]):
        reader.problem("bad-optional", f"{reader.what}: only the last fields can be optional")
    without = tuple(field for field in full if field.echo != "optional")
    if without != full:
        variants.append(without)
    return tuple(variants)


def _variant(nodes: tuple[Node, ...], direction: Direction, outer: Reader, types: Types) -> Variant:
    plain = [_read(node, direction, outer, types) for node in nodes]
    fields = tuple(_selected(field, inner, plain, types) for field, inner in plain)
    return _counted(fields, [inner for _, inner in plain])


def _counted(fields: Variant, readers: list[Reader]) -> Variant:
    """Return the fields; ``counts`` of each names the field of which it counts the elements."""
    counts: dict[str, str] = {}
    earlier: dict[str, Field] = {}
    to_the_end = 0
    for field, reader in zip(fields, readers):
        name = reader.get(language.RequestField.count)
        place = reader.place_of(language.RequestField.count) if name else reader.place
        if name and (name not in earlier or not _can_count(earlier[name], field)):
            message = (
                f"count: {name} must be an earlier whole number of the message that can hold "
                f"{field.type.sizes[1]}, and the type of {field.name} must vary in size"
            )
            reader.problem("bad-count", message, place)
        elif name:
            counts[name] = field.name
        elif field.type.varies:
            to_the_end += 1
        if to_the_end > 1:
            message = f"a second field of {reader.what} extends to the end; give it a count"
            reader.problem("bad-count", message, place)
        earlier[field.name] = field
    return tuple(replace(field, counts=counts.get(field.name, "")) for field in fields)


def _can_count(field: Field, listed: Field) -> bool:
    type, (least, most) = field.type, listed.type.sizes
    if not isinstance(type, Quantity) or type.real or field.selector or field.const is not None:
        return False
    lowest, highest = type.ends
    return listed.type.varies and lowest <= least and most <= highest and not type.choices


def build_field(node: Node, direction: Direction, outer: Reader, types: Types) -> Field:
    """Return one field with a type that does not depend on another field."""
    [field] = _variant((node,), direction, outer, types)
    return field


def _read(node: Node, direction: Direction, outer: Reader, types: Types) -> tuple[Field, Reader]:
    spec = language.RequestField
    name = label(node, spec.name)
    what = f"the field {name} of {outer.what}" if name else f"a field of {outer.what}"
    reader = Reader(node, language.FIELDS[direction], what, outer.problems)
    is_selected = "selector" in reader.record.keys()  # noqa: SIM118
    type: Type = stand_in(node.place)
    if not is_selected and reader.node(spec.type) is not None:
        type = types.find(reader.get(spec.type), reader.place_of(spec.type))
    type = _narrowed(type, reader, is_selected)
    field = Field(
        place=node.place,
        name=reader.get(spec.name),
        type=type,
        doc=reader.get(spec.doc) or type.doc,
        echo=_echo(reader) if direction == "reply" else "",
        optional=reader.get(spec.optional_),
        const=_const(reader, type),
        selector=reader.get(language.SelectedRequestField.selector) if is_selected else "",
        cases=(),
        default=_default(reader, type),
    )
    return field, reader


def _narrowed(type: Type, reader: Reader, is_selected: bool) -> Type:
    """Return the type with the range that the field gives it."""
    narrowed = reader.get(language.RequestField.range)
    if narrowed is None:
        return type
    inside = None if is_selected else type.narrowed(narrowed)
    if inside is not None:
        return inside
    if is_selected or type.kind != "quantity":
        message = f"{reader.what} is not a quantity; remove its range"
    else:
        message = f"the range of {reader.what} is not inside that of its type {type.name}"
    reader.problem("bad-range", message)
    return type


def _echo(reader: Reader) -> Literal["", "required", "optional"]:
    word = reader.get(language.ReplyField.echo)
    if word == "required":
        return "required"
    return "optional" if word == "optional" else ""


def _const(reader: Reader, type: Type) -> int | None:
    key = language.RequestField.const
    if reader.node(key) is None:
        return None
    value = reader.get(key)
    if isinstance(value, str):
        members = {each.name: each.value for each in type.members} if type.kind == "enum" else {}
        if value not in members:
            message = f"the const {value} of {reader.what} is not a member of its type"
            hint = nearest(value, members)
            reader.problem("bad-const", f"{message}{hint}", reader.place_of(key))
        return members.get(value)
    if not type.can_hold(value):
        reader.problem("bad-const", f"the const {value} of {reader.what} does not fit its type")
        return None
    return value


def _default(reader: Reader, type: Type) -> tuple[int, ...] | None:
    """Return the raw values of an argument's default."""
    key = language.RequestField.default
    node = reader.node(key) if key.name in reader.record.keys() else None  # noqa: SIM118
    if node is None:
        return None
    spec = language.RequestField
    if reader.node(spec.const) is not None or reader.get(spec.optional_):
        other = "const" if reader.node(spec.const) is not None else "optional"
        message = f"{reader.what} has both a default and {other}; keep one of them"
        reader.problem("bad-default", message, node.place)
        return None
    try:
        return raw_values(type, reader.get(spec.name), plain_value(node))
    except ValueError as error:
        reader.problem("bad-default", f"the default of {reader.what}: {error}", node.place)
        return None


def _selected(
    field: Field, reader: Reader, plain: list[tuple[Field, Reader]], types: Types
) -> Field:
    """Return a field with its cases, one for each value of its selector, if it has a selector."""
    if not field.selector:
        return field
    selector = next((other for other, _ in plain if other.name == field.selector), None)
    members = _values(selector)
    if not members:
        message = f"selector: {field.selector} must name a field of the message with few values"
        reader.problem("bad-selector", message)
    cases: list[tuple[Member, Type]] = []
    for name, place, node in reader.get(language.SelectedRequestField.cases):
        inner = Reader(node, language.Case, f"the case {name} of {reader.what}", reader.problems)
        type = types.find(inner.get(language.Case.type), node.place)
        if name in members:
            cases.append((members.pop(name), type))
        elif selector is not None:
            message = f"{name} is not a value of {field.selector}"
            reader.problem("unknown-case", f"{message}{nearest(name, members)}", place)
    for name in members:
        reader.problem("missing-case", f"{reader.what} has no case for {name}")
    first = cases[0][1] if cases else field.type
    return replace(field, type=first, doc=field.doc or first.doc, cases=tuple(cases))


def _values(selector: Field | None) -> dict[str, Member]:
    """Return the values of a selector by the names that its cases use."""
    if selector is None or selector.selector:
        return {}
    values = selector.type.values(MOST_CASES)
    return {member.name: replace(member, place=selector.place) for member in values}
