"""The model to the table that codecs interpret: types resolved, scales as integer pairs."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import Any

from cobotwire_codegen.model import (
    Command,
    Dispute,
    Edition,
    Enum,
    Field,
    Flag,
    Quantity,
    Type,
    Value,
    Wire,
)


def numbers(type: Type) -> tuple[dict[str, Any], ...]:
    """The numbers of a type, in wire order."""
    if isinstance(type, Value):
        return tuple(_quantity(name, item) for name, item in type.items)
    if isinstance(type, Quantity):
        return (_quantity("", type),)
    if isinstance(type, Enum):
        values = [member.value for member in type.members]
        return (_number("", type.wire, min(values), max(values)),)
    return (_number("", type.wire, 0, 1),)


def _quantity(name: str, quantity: Quantity) -> dict[str, Any]:
    lowest, highest = quantity.bounds
    number = _number(name, quantity.wire, int(lowest), int(highest))
    number["multiply"] = quantity.scale.numerator
    number["divide"] = quantity.scale.denominator
    number["unit"] = quantity.unit
    return number


def _number(name: str, wire: Wire, minimum: int, maximum: int) -> dict[str, Any]:
    return {
        "name": name,
        "width": wire.width,
        "order": wire.order,
        "signed_at": wire.signed_at,
        "multiply": 1,
        "divide": 1,
        "minimum": minimum,
        "maximum": maximum,
        "unit": "",
    }


def kind(type: Type) -> str:
    """How a value of the type is spelt."""
    if isinstance(type, Flag):
        return "flag"
    return "enum" if isinstance(type, Enum) else "number"


def choices(type: Type) -> tuple[int, ...]:
    """The closed list of whole numbers, or nothing."""
    if isinstance(type, Flag):
        return (0, 1)
    if isinstance(type, Quantity):
        return type.choices
    return tuple(member.value for member in type.members) if isinstance(type, Enum) else ()


def field_choices(field: Field) -> tuple[int, ...]:
    """The closed list of a field: a constant has one entry."""
    return choices(field.type) if field.const is None else (field.const,)


def labels(type: Type) -> tuple[str, ...]:
    """The words for the choices, or nothing."""
    return tuple(member.name for member in type.members) if isinstance(type, Enum) else ()


def cases(field: Field) -> Iterator[tuple[tuple[int, ...], Type]]:
    """The field's types with the selector's values that pick them; neighbours joined."""
    if not field.by:
        yield (), field.type
    for type, group in groupby(field.cases, key=lambda case: case[1]):
        yield tuple(member.value for member, _ in group), type


def notes(command: Command) -> tuple[str, ...]:
    """What a reader of the command should know beside its description."""
    return (*command.notes, *(dispute_note(dispute) for dispute in command.disputed))


def dispute_note(dispute: Dispute) -> str:
    """A dispute in one sentence."""
    return f"Disputed: {dispute.claim} Read: {dispute.reading} (confidence {dispute.confidence})."


def selector(field: Field, form: tuple[Field, ...]) -> int:
    """The index, in a form, of the field that decides this one's type."""
    names = [other.name for other in form]
    return names.index(field.by) if field.by else -1


def table(edition: Edition) -> dict[str, Any]:
    """The table as plain data."""
    return {
        "edition": edition.name,
        "title": edition.title,
        "joints": edition.joints,
        "baudrate": edition.frame.baudrate,
        "frame": {
            "header": list(edition.frame.header),
            "footer": list(edition.frame.footer),
            "maximum_length": maximum_length(edition),
            "check": edition.frame.check,
            "addresses": [member.value for member in edition.frame.addresses],
        },
        "commands": [
            _command(family.name, c) for family in edition.families for c in family.commands
        ],
    }


def maximum_length(edition: Edition) -> int:
    """The highest LEN that the frame can carry."""
    return 1 + edition.frame.maximum_data + edition.frame.check_size


def _command(family: str, command: Command) -> dict[str, Any]:
    text = command.text
    return {
        "id": command.id,
        "name": command.name,
        "title": command.title,
        "doc": command.doc,
        "family": family,
        "safety": command.safety,
        "deadline_ms": command.deadline_ms,
        "request": [_layout(form) for form in command.forms("request")],
        "reply": [_layout(form) for form in command.forms("reply")],
        "text": text
        and {
            "prefixes": list(text.prefixes),
            "fields": [name for name, _ in text.fields],
            "silence_ms": text.silence_ms,
            "suffix": text.suffix,
        },
        "notes": list(notes(command)),
        "ack": command.ack,
        "request_text": command.request_text
        and {
            "prefixes": list(command.request_text.prefixes),
            "fields": [name for name, _ in command.request_text.fields],
            "suffix": command.request_text.suffix,
        },
        "role": command.role,
        "read_by": command.read_by
        and {
            "query": command.read_by.query,
            "fields": [list(pair) for pair in command.read_by.fields],
        },
        "tries": [[[name, list(numbers)] for name, numbers in tried] for tried in command.tries],
        "agrees_with": list(command.agrees_with),
    }


def _layout(form: tuple[Field, ...]) -> dict[str, Any]:
    return {"fields": [_field(field, form) for field in form]}


def _field(field: Field, form: tuple[Field, ...]) -> dict[str, Any]:
    return {
        "name": field.name,
        "kind": kind(field.type),
        "cases": [
            {"when": list(when), "numbers": list(numbers(type))} for when, type in cases(field)
        ],
        "doc": field.doc,
        "many": isinstance(field.type, Value),
        "choices": list(field_choices(field)),
        "labels": list(labels(field.type)) if field.const is None else [],
        "selector": selector(field, form),
        "echo": bool(field.echo),
    }
