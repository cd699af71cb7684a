"""Describes types and sources in words, for docstrings and the reference."""

from __future__ import annotations

from cobotwire_codegen import lower
from cobotwire_codegen.model import (
    Field,
    Lines,
)
from cobotwire_codegen.model.types import decimal as decimal
from cobotwire_codegen.units import UNITS


def allowed(field: Field) -> str:
    """Return the allowed values of an argument in words: shape, unit, range."""
    words = []
    for when, type in lower.cases(field):
        names = [member.name for member, _ in field.cases if member.value in when]
        prefix = f"for {', '.join(names)}: " if names else ""
        words.append(prefix + type.span)
    return "; ".join(words)


def lines(spans: Lines) -> str:
    """Return line numbers of the document in words."""
    text = ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in spans)
    one = len(spans) == 1 and spans[0][0] == spans[0][1]
    return f"line {text}" if one else f"lines {text}"


def units(unit: str) -> str:
    """Return a unit's plural, which follows a number."""
    return UNITS[unit].plural
