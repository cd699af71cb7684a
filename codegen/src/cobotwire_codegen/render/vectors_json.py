"""Writes the table and its vectors as JSON, for tests in other languages than Python."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

from cobotwire_codegen.lower import table
from cobotwire_codegen.model import Edition, Enum, Vector
from cobotwire_codegen.wire import encode_variant


def vectors_json(edition: Edition) -> str:
    """Return the file that the Rust tests read."""
    # A line for each vector. Python's json is many times slower if it indents.
    vectors = ",\n".join(json.dumps(_vector(edition, vector)) for vector in edition.vectors)
    return (
        '{"generated": "by cobotwire-gen from spec/; not to be edited",\n'
        f'"table": {json.dumps(table(edition))},\n'
        f'"vectors": [\n{vectors}\n]}}\n'
    )


def _vector(edition: Edition, vector: Vector) -> dict[str, Any]:
    return {
        "name": vector.name,
        "command": vector.command,
        "direction": vector.direction,
        "printed": _hex(vector.printed),
        "frame": _hex(vector.frame),
        "text": vector.text is not None,
        "values": [plain(edition, vector, name, value) for name, value in vector.values],
        "rejected": vector.rejected
        and {"reason": vector.rejected[0], "offset": vector.rejected[1]},
    }


def plain(edition: Edition, vector: Vector, name: str, value: object) -> Any:
    """Return a vector's value as the codecs expect it: members as integers, fractions as floats."""
    if isinstance(value, tuple):
        return [plain(edition, vector, name, item) for item in value]
    if isinstance(value, Fraction):
        return float(value)
    # Only a text or a truth value can stand for the number of a member.
    if vector.frame is None or type(value) is int:
        return value
    command = edition.by_name[vector.command]
    variant, _ = encode_variant(command, vector.direction, dict(vector.values))
    field = next(field for field in variant if field.name == name)
    if not isinstance(field.type, Enum):
        return value
    if field.const is not None:
        return field.const
    return next(member.value for member in field.type.members if member.name == value)


def _hex(data: bytes | None) -> str | None:
    return None if data is None else data.hex(" ").upper()
