"""Builds the parts of the JSON Schema that describes the spec."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

Schema = dict[str, Any]


def ref(definition: str) -> Schema:
    """Return a reference to a definition of the schema."""
    return {"$ref": f"#/definitions/{definition}"}


def closed(doc: str, properties: Schema, required: Iterable[str]) -> Schema:
    """Return the schema of a mapping that has only the given keys."""
    return {
        "type": "object",
        "description": doc,
        "additionalProperties": False,
        "required": list(required),
        "properties": properties,
    }


def either(kind: str, then: Schema, otherwise: Schema) -> Schema:
    """Return one schema for a kind of value and another one for all others.

    An ``anyOf`` would be shorter, but an editor can then only report that nothing matched.
    """
    return {"if": {"type": kind}, "then": then, "else": otherwise}


def by_key(chosen: Iterable[tuple[str, Schema]], otherwise: Schema) -> Schema:
    """Return the schema that belongs to the first of the keys that a mapping has."""
    for key, schema in reversed(tuple(chosen)):
        otherwise = {"if": {"required": [key]}, "then": schema, "else": otherwise}
    return otherwise
