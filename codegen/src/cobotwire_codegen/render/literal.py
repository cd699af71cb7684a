"""Lays out Python expressions as ruff does, so that generated code is formatted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

WIDTH = 100


@dataclass(frozen=True, slots=True)
class Name:
    """A name, or other text that is written unchanged."""

    text: str


def literal(value: Any, indent: int = 0, before: int = 0, after: int = 0) -> str:
    """Return the text of an expression.

    ``indent`` is the column of the statement; ``before`` and ``after`` count the other characters
    on the same line.
    """
    flat = _flat(value)
    if indent + before + len(flat) + after <= WIDTH or not isinstance(value, tuple):
        return flat
    lines = [f"{' ' * (indent + 4)}{literal(part, indent + 4, after=1)}," for part in value]
    return "\n".join(["(", *lines, " " * indent + ")"])


def _flat(value: Any) -> str:
    if isinstance(value, Name):
        return value.text
    if isinstance(value, tuple):
        inner = ", ".join(map(_flat, value))
        return f"({inner},)" if len(value) == 1 else f"({inner})"
    return quoted(value) if isinstance(value, str) else repr(value)


def quoted(text: str) -> str:
    """Return a string literal, in double quotes unless that needs more escapes."""
    plain = repr(text)
    if plain.startswith("'") and '"' not in text:
        return '"' + plain[1:-1].replace("\\'", "'") + '"'
    return plain
