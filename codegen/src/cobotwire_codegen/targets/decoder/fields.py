"""Describes commands for the decoder page, each with the variants of its messages.

Messages that differ only in the number of elements of a list are one variant here.
"""

from __future__ import annotations

from typing import Any

from cobotwire_codegen import lower
from cobotwire_codegen.model import Chars, Command, Field, Listed, Octets, Quantity, Type, Variant

Record = dict[str, Any]


def command_record(family: str, command: Command) -> Record:
    """Return a command with what the page decodes and shows."""
    return {
        "id": command.id,
        "name": command.name,
        "title": command.title,
        "family": family,
        "safety": command.safety,
        **({"event": True} if command.event else {}),
        "request": [_variant(variant) for variant in command.variants("request")],
        "reply": [_variant(variant) for variant in command.variants("reply")],
    }


def _variant(variant: Variant) -> Record:
    return {"fields": [_field(field, variant) for field in variant]}


def _field(field: Field, variant: Variant) -> Record:
    type = field.type.of if isinstance(field.type, Listed) else field.type
    record: Record = {
        "name": field.name,
        "kind": type.kind if isinstance(type, Octets | Chars) else lower.kind(type),
        "cases": [
            {"when": list(when), "numbers": _numbers(case)} for when, case in lower.cases(field)
        ],
        "choices": _choices(field, type),
        "labels": list(lower.labels(type)) if field.const is None else [],
        "selector": lower.selector(field, variant),
    }
    if isinstance(field.type, Octets | Chars | Listed):
        record["least"], record["most"] = field.type.sizes
    if isinstance(field.type, Listed) and isinstance(type, Chars):
        record["repeat"] = type.size
    if isinstance(type, Chars):
        record["encoding"] = type.encoding
        record["padding"] = -1 if type.padding is None else type.padding
    if field.counts:
        record["counts"] = [other.name for other in variant].index(field.counts)
    return record


def _choices(field: Field, type: Type) -> list[int | str]:
    """Return the closed list; raw values of floats are texts, like their bounds."""
    found = lower.field_choices(field)
    is_float = isinstance(type, Quantity) and type.wire.is_float
    return [str(raw) if is_float else raw for raw in found]


def _numbers(type: Type) -> list[Record]:
    """Return the numbers of one element, or the number of each byte of bytes and texts."""
    inner = type.of if isinstance(type, Listed) else type
    if isinstance(inner, Octets | Chars):
        return [lower.byte_number(inner)]
    found = lower.numbers(inner)
    return [_float(number) if number.get("encoding") == "float" else number for number in found]


def _float(number: Record) -> Record:
    """Return the number of a float; JavaScript reads its bounds exactly only from texts."""
    return {**number, **{end: str(number[end]) for end in ("minimum", "maximum")}}
