"""Lays out Python expressions as ruff does, so that generated code is formatted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

WIDTH = 100


@dataclass(frozen=True, slots=True)
class Name:
    """A name, or other text that is written unchanged."""

    text: str


class Call:
    """A call: positional arguments, then keywords."""

    def __init__(self, function: str, *arguments: Any, **keywords: Any) -> None:
        self.function = function
        self.arguments = arguments
        self.keywords = keywords


def literal(value: Any, indent: int = 0, before: int = 0, after: int = 0) -> str:
    """Return the text of an expression.

    ``indent`` is the column of the statement; ``before`` and ``after`` count the other characters
    on the same line.
    """
    flat = _flat(value)
    if indent + before + len(flat) + after <= WIDTH or not _parts(value):
        return flat
    opening, parts, closing = _brackets(value), _parts(value), ")"
    inner = " " * (indent + 4)
    joined = ", ".join(name + _flat(part) for name, part in parts)
    # ruff first tries to put the arguments of a call, but not of a tuple, on one separate line.
    if isinstance(value, Call) and len(parts) > 1 and indent + 4 + len(joined) <= WIDTH:
        return f"{opening}\n{inner}{joined}\n{' ' * indent}{closing}"
    lines = [f"{inner}{name}{literal(part, indent + 4, len(name), 1)}," for name, part in parts]
    return "\n".join([opening, *lines, " " * indent + closing])


def _brackets(value: Any) -> str:
    return f"{value.function}(" if isinstance(value, Call) else "("


def _parts(value: Any) -> list[tuple[str, Any]]:
    if isinstance(value, Call):
        keywords = [(f"{name}=", part) for name, part in value.keywords.items()]
        return [("", part) for part in value.arguments] + keywords
    return [("", part) for part in value] if isinstance(value, tuple) else []


def _flat(value: Any) -> str:
    if isinstance(value, Name):
        return value.text
    if isinstance(value, Call) or (isinstance(value, tuple) and value):
        inner = ", ".join(name + _flat(part) for name, part in _parts(value))
        comma = "," if isinstance(value, tuple) and len(value) == 1 else ""
        return f"{_brackets(value)}{inner}{comma})"
    if isinstance(value, str):
        return quoted(value)
    return repr(value)


def quoted(text: str) -> str:
    """Return a string literal, in double quotes unless that needs more escapes."""
    plain = repr(text)
    if plain.startswith("'") and '"' not in text:
        return '"' + plain[1:-1].replace("\\'", "'") + '"'
    return plain
