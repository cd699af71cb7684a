"""Escapes the texts of a spec for Markdown. No other module does so.

The whole model is copied with escaped texts before the templates see it, so that no template can
forget to escape. The names in a model are identifiers, which Markdown takes as they are.
"""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model import Text, Vector

T = TypeVar("T")
# Attributes that no template shows, or that templates show as code, where escapes would be visible.
_AS_CODE: dict[type, tuple[str, ...]] = {Text: ("prefixes", "suffix"), Vector: ("text",)}
# Signs that start a block at the start of a line: list, heading, quotation, fence, comment, label.
_BLOCK = re.compile(r"\A([-+*=#>~:%]|\((?=[^)]*\)=)|\d+(?=[.)](\s|\Z)))")
_SIGNS = re.compile(r"([\\`\[\]|$]|\*(?=\S)|(?<=\S)\*)")


def markdown(text: str) -> str:
    """Return text that Markdown shows as it is, in a paragraph or in a cell of a table."""
    safe = text.replace("&", "&amp;").replace("<", "&lt;")
    safe = _SIGNS.sub(r"\\\1", safe)
    return _BLOCK.sub(lambda m: f"{m[1]}\\" if m[1].isdigit() else f"\\{m[1]}", safe)


def code(text: str) -> str:
    """Return text as inline code; the fence is longer than any row of backticks in the text."""
    longest = max((len(row) for row in re.findall("`+", text)), default=0)
    fence = "`" * (longest + 1)
    gap = " " if text.startswith("`") or text.endswith("`") else ""
    return f"{fence}{gap}{text}{gap}{fence}"


def escaped(model: T) -> T:
    """Return a model (or a part of it) with every text escaped."""
    made: T = _Escape().value(model)
    return made


class _Escape:
    """Copies values, each object once, so that equal parts stay the same object."""

    def __init__(self) -> None:
        self._made: dict[int, tuple[Any, Any]] = {}

    def value(self, value: Any) -> Any:
        """Return a value with every text escaped."""
        if isinstance(value, str):
            return markdown(value)
        if isinstance(value, tuple):
            return tuple(self.value(item) for item in value)
        if isinstance(value, Place) or not is_dataclass(value) or isinstance(value, type):
            return value
        if id(value) not in self._made:
            kept = _AS_CODE.get(type(value), ())
            names = [f.name for f in fields(value) if f.init and f.name not in kept]
            changed = {name: self.value(getattr(value, name)) for name in names}
            # Keep the original too, so that its id is not used again.
            self._made[id(value)] = (value, replace(value, **changed))
        return self._made[id(value)][1]
