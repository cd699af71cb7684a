"""The leaves of the schema, and the few shapes that its objects have.

A key takes what ``reader.Reader`` takes for it, no more: the editor refuses what the checker does.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

Schema = dict[str, Any]

# What names are in the generated Python; check/names.py holds the same rule.
LOWER, UPPER = r"^[a-z][a-z0-9_]*$", r"^[A-Z][A-Z0-9_]*$"
METHOD = r"^[a-z][A-Za-z0-9_]*$"
CLASS = r"^[A-Z][A-Za-z0-9]*$"
_EXACT = r"^\s*-?[0-9]+(\.[0-9]*)?(/[0-9]+)?\s*$"
_LINES = r"^[0-9]+(-[0-9]+)?$"


def text(doc: str) -> Schema:
    """A word or sentence that must be there; a number is taken for its digits."""
    return {"type": ["string", "integer"], "pattern": r"\S", "description": doc}


def free(doc: str) -> Schema:
    """A word or sentence that may be left out."""
    return {"type": "string", "pattern": r"\S", "description": doc}


def name(doc: str, pattern: str = LOWER) -> Schema:
    """A name of the generated Python."""
    return {"type": "string", "pattern": pattern, "description": doc}


def whole(doc: str, lowest: int | None = None, highest: int | None = None) -> Schema:
    """A whole number."""
    bounds = {"minimum": lowest, "maximum": highest}
    limits = {key: value for key, value in bounds.items() if value is not None}
    return {"type": "integer", **limits, "description": doc}


def yes(doc: str) -> Schema:
    """True or false."""
    return {"type": "boolean", "description": doc}


def exact(doc: str) -> Schema:
    """An exact number: 1/100, 0.01 or 3."""
    return {"type": ["number", "string"], "pattern": _EXACT, "description": doc}


def hexed(doc: str) -> Schema:
    """Bytes as pairs of hex digits; those without a letter are a number to YAML."""
    pattern = r"^\s*([0-9A-Fa-f]{2}\s*)*$"
    return {"type": ["string", "integer"], "pattern": pattern, "description": doc}


def lines(doc: str) -> Schema:
    """Lines of the document: 12, 20-39, or a list of these."""
    one: Schema = {"type": ["integer", "string"], "minimum": 1, "pattern": _LINES}
    return {**either("array", {"items": one}, one), "description": doc}


def one_of(words: Iterable[str], doc: str, docs: Iterable[str] = ()) -> Schema:
    """A word of a closed list; ``docs`` are shown beside the words."""
    beside = list(docs)
    shown = {"enumDescriptions": beside} if beside else {}
    return {"enum": list(words), **shown, "description": doc}


def range_of(doc: str) -> Schema:
    """A pair of numbers."""
    ends: Schema = {"items": exact("A number."), "minItems": 2, "maxItems": 2}
    return {"type": "array", **ends, "description": doc}


def listed(item: Schema, doc: str, least: int = 0) -> Schema:
    """A list."""
    shortest = {"minItems": least} if least else {}
    return {"type": "array", "items": item, **shortest, "description": doc}


def words(doc: str, item: Schema | None = None) -> Schema:
    """A word, or a list of words."""
    one = item or {"type": "string"}
    return {**either("array", {"items": one}, one), "description": doc}


def named(item: Schema, doc: str, pattern: str = LOWER) -> Schema:
    """A mapping from names to things of one kind."""
    keys = {"propertyNames": {"pattern": pattern}}
    return {"type": "object", **keys, "additionalProperties": item, "description": doc}


def closed(doc: str, required: Schema, optional: Schema | None = None) -> Schema:
    """A mapping with just these keys."""
    return {
        "type": "object",
        "description": doc,
        "additionalProperties": False,
        "required": list(required),
        "properties": {**required, **(optional or {})},
    }


def ref(definition: str) -> Schema:
    """What is defined elsewhere in the schema."""
    return {"$ref": f"#/definitions/{definition}"}


def either(kind: str, then: Schema, otherwise: Schema) -> Schema:
    """One schema for a kind of node, another one for all others.

    Not ``anyOf``: of that an editor can only say that nothing fitted.
    """
    return {"if": {"type": kind}, "then": then, "else": otherwise}


def by_key(chosen: Iterable[tuple[str, Schema]], otherwise: Schema) -> Schema:
    """The schema of the first key that a mapping has."""
    for key, schema in reversed(tuple(chosen)):
        otherwise = {"if": {"required": [key]}, "then": schema, "else": otherwise}
    return otherwise
