"""The shape of `meanings`: what single raw values, or ranges of them, stand for."""

from __future__ import annotations

import re
from itertools import pairwise

from cobotwire_codegen.language.json_schema import Schema
from cobotwire_codegen.language.shapes import Note, Shape
from cobotwire_codegen.load import Mapping, Node, Scalar

# The lowest and highest raw value, and what they stand for.
Meanings = tuple[tuple[int, int, str], ...]

_SPAN = re.compile(r"(-?[0-9]+)(?:\.\.(-?[0-9]+))?\Z")
NUMBER = "{number}"


class MeaningsOfNumbers(Shape[Meanings]):
    """A mapping of raw values, or ranges such as ``1..6``, to texts."""

    blank = ()
    words = "texts by raw values or ranges, such as 0 or 1..6, that do not overlap"

    def read(self, node: Node, subject: str, note: Note) -> Meanings:
        """Return the lowest and highest raw value of each meaning, and its text, in order."""
        found = []
        for key, value in node.entries.items() if isinstance(node, Mapping) else [("", node)]:
            span = _SPAN.match(key)
            text = value.value if isinstance(value, Scalar) else None
            if span is None or not isinstance(text, str) or not text.strip():
                return self._wrong(value, subject, note, "bad-meaning")
            low = int(span[1])
            found.append((low, int(span[2] or low), " ".join(text.split())))
        found.sort()
        ends = [end for low, high, _ in found for end in (low, high)]
        apart = all(before[1] < after[0] for before, after in pairwise(found))
        return (
            tuple(found)
            if ends == sorted(ends) and apart
            else self._wrong(node, subject, note, "bad-meaning")
        )

    def schema(self) -> Schema:
        """Return an object with a pattern for its keys."""
        return {
            "type": "object",
            "propertyNames": {"pattern": "^" + _SPAN.pattern.replace(r"\Z", "$")},
            "additionalProperties": {"type": "string", "pattern": r"\S"},
            "minProperties": 1,
        }


def in_words(meanings: Meanings) -> str:
    """Return all meanings as a sentence; empty if there are none."""
    parts = []
    for low, high, text in meanings:
        span = str(low) if low == high else f"{low} to {high}"
        parts.append(f"{span}: {text.replace(NUMBER, 'n')}")
    return "; ".join(parts) + "." if parts else ""
