"""Lowers the model to the table that codecs interpret: types resolved, scales as integer pairs."""

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
    Listed,
    Quantity,
    Type,
    Value,
)


def numbers(type: Type) -> tuple[dict[str, Any], ...]:
    """Return the numbers of a type in wire order, for the templates of users (docs/targets.md)."""
    return type.numbers


def kind(type: Type) -> str:
    """Return the kind of a field of this type."""
    return type.kind if isinstance(type, Enum | Flag) else "number"


def field_choices(field: Field) -> tuple[int, ...]:
    """Return the legal raw values of a field, if they are listed; for a list, of its elements.

    A constant has one. The cases of a field may be quantities with different choices, so those are
    in their numbers.
    """
    if field.const is not None:
        return (field.const,)
    type = field.type.of if isinstance(field.type, Listed) else field.type
    return () if field.selector and isinstance(type, Quantity) else type.choices


def labels(type: Type) -> tuple[str, ...]:
    """Return the names of the choices; empty if they have none."""
    return tuple(member.name for member in type.members)


def cases(field: Field) -> Iterator[tuple[tuple[int, ...], Type]]:
    """Yield the field's types, each with its selector values; adjacent equal types are joined."""
    if not field.selector:
        yield (), field.type
    for type, group in groupby(field.cases, key=lambda case: case[1]):
        yield tuple(member.value for member, _ in group), type


def message_class(command: str) -> str:
    """Return the name of a command's request class: ``get_angles`` gives ``GetAngles``."""
    return "".join(word[:1].upper() + word[1:] for word in command.split("_"))


def notes(command: Command) -> tuple[str, ...]:
    """Return the notes of a command, including its disputes."""
    return (*command.notes, *(dispute_note(dispute) for dispute in command.disputed))


def dispute_note(dispute: Dispute) -> str:
    """Return a dispute as a note."""
    return (
        f"Disputed: {dispute.claim} Read as: {dispute.reading} (confidence {dispute.confidence})."
    )


def selector(field: Field, variant: tuple[Field, ...]) -> int:
    """Return the index, in the variant, of the field's selector; -1 if it has none."""
    names = [other.name for other in variant]
    return names.index(field.selector) if field.selector else -1


def table(edition: Edition) -> dict[str, Any]:
    """Return the table as plain data."""
    return {
        "edition": edition.name,
        "title": edition.title,
        "joints": edition.joints,
        "baudrate": edition.frame.baudrate,
        "frame": {
            "header": list(edition.frame.header),
            "footer": list(edition.frame.footer),
            "maximum_length": maximum_length(edition),
            "check": edition.frame.check_word,
            "addresses": list(edition.frame.address_values),
        },
        "commands": [
            _command(family.name, c) for family in edition.families for c in family.commands
        ],
    }


def maximum_length(edition: Edition) -> int:
    """Return the highest LEN of a frame."""
    return edition.frame.maximum_length


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
        "request": [_variant(variant) for variant in command.variants("request")],
        "reply": [_variant(variant) for variant in command.variants("reply")],
        "text": text
        and {
            "prefixes": list(text.prefixes),
            "fields": [name for name, _ in text.fields],
            "silence_ms": text.silence_ms,
            "suffix": text.suffix,
        },
        "notes": list(notes(command)),
        "ack": command.ack,
        "event": command.event,
        "accepted": list(command.accepted),
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
        "samples": [
            [[name, list(numbers)] for name, numbers in sample] for sample in command.samples
        ],
        "agrees_with": list(command.agrees_with),
        "arguments": list(command.method_order),
    }


def _variant(variant: tuple[Field, ...]) -> dict[str, Any]:
    return {"fields": [_field(field, variant) for field in variant]}


def _field(field: Field, variant: tuple[Field, ...]) -> dict[str, Any]:
    return {
        "name": field.name,
        "kind": kind(field.type),
        "cases": [
            {"when": list(when), "numbers": list(type.numbers)} for when, type in cases(field)
        ],
        "doc": field.doc,
        "many": isinstance(field.type, Value | Listed),
        "choices": list(field_choices(field)),
        "labels": list(labels(field.type)) if field.const is None else [],
        "selector": selector(field, variant),
        "echo": bool(field.echo),
        "const": field.const,
        "default": None if field.default is None else list(field.default),
    }
