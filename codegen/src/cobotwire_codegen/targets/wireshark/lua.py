"""Writes Lua expressions as text."""

from __future__ import annotations

from typing import Any

WIDTH = 100


class Name(str):
    """A name, or other text that is written unchanged."""


def lua(value: Any, indent: int = 0, before: int = 0) -> str:
    """Return the text of an expression: on one line if it fits, else a line for each part.

    ``indent`` is the column of the statement; ``before`` counts the characters to its left.
    """
    flat = _flat(value)
    if not isinstance(value, (dict, list, tuple)) or indent + before + len(flat) < WIDTH:
        return flat
    inner = " " * (indent + 2)
    lines = [f"{inner}{key}{lua(part, indent + 2, len(key))}," for key, part in _parts(value)]
    return "\n".join(["{", *lines, " " * indent + "}"])


def _parts(value: Any) -> list[tuple[str, Any]]:
    if isinstance(value, dict):
        return [(f"{_key(key)} = ", part) for key, part in value.items()]
    return [("", part) for part in value]


def _key(key: Any) -> str:
    return key if isinstance(key, str) else f"[{key}]"


def _flat(value: Any) -> str:
    if isinstance(value, Name):
        return value
    if isinstance(value, (str, bytes)):
        return quoted(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if not isinstance(value, (dict, list, tuple)):
        raise TypeError(f"cannot write {value!r} in Lua")
    parts = ", ".join(key + _flat(part) for key, part in _parts(value))
    return f"{{ {parts} }}" if parts else "{}"


def quoted(text: str | bytes) -> str:
    """Return a string literal; bytes that are not printable ASCII are escaped."""
    data = text.encode() if isinstance(text, str) else text
    return '"' + "".join(map(_character, data)) + '"'


def _character(byte: int) -> str:
    if byte in b'"\\':
        return "\\" + chr(byte)
    return chr(byte) if 32 <= byte < 127 else f"\\{byte:03d}"
