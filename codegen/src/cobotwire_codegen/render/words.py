"""Describes types and sources in words, for docstrings and the reference."""

from __future__ import annotations

from fractions import Fraction

from cobotwire_codegen import lower
from cobotwire_codegen.language.units import UNITS
from cobotwire_codegen.model import (
    Bits,
    Chars,
    Enum,
    Field,
    Flag,
    Lines,
    Listed,
    Octets,
    Quantity,
    Type,
    Value,
)


def allowed(field: Field) -> str:
    """Return the allowed values of an argument in words: shape, unit, range."""
    words = []
    for when, type in lower.cases(field):
        names = [member.name for member, _ in field.cases if member.value in when]
        prefix = f"for {', '.join(names)}: " if names else ""
        words.append(prefix + span(type))
    return "; ".join(words)


def span(type: Type) -> str:
    """Return shape, unit and range of a type in words."""
    if isinstance(type, Flag):
        return "True or False"
    if isinstance(type, Enum):
        return "one of " + ", ".join(f"{member.name} ({member.value})" for member in type.members)
    if isinstance(type, Quantity) and type.choices:
        return "one of " + ", ".join(map(str, type.choices))
    if isinstance(type, Quantity):
        lowest, highest = type.ends
        unit = f" {units(type.unit)}" if type.unit else ""
        if type.not_finite:
            return f"a number{unit}, also infinity and NaN"
        if type.wire.is_float and type.range is None:
            return f"a finite number of {type.wire.width} bytes{unit and f', in{unit}'}"
        return f"{decimal(lowest)}..{decimal(highest)}{unit}"
    if not isinstance(type, Value):
        return _shape(type)
    names = [name for name, _ in type.items]
    spans: dict[str, list[str]] = {}
    for name, item in type.items:
        spans.setdefault(span(item), []).append(name)
    inner = "; ".join(f"{', '.join(group)} {words}" for words, group in spans.items())
    return f"{len(names)} numbers ({inner})"


def _shape(type: Bits | Octets | Chars | Listed) -> str:
    least, most = type.sizes
    sizes = str(most) if least == most else f"{least}..{most}"
    if isinstance(type, Octets):
        return f"{sizes} bytes"
    if isinstance(type, Chars):
        at_most = "at most " if type.padding is not None else ""
        return f"{type.encoding} text of {at_most}{sizes} bytes"
    if isinstance(type, Listed):
        return f"{sizes} elements: {span(type.of)}"
    parts = [f"{name} {span(part)}" for name, part in type.items]
    return f"{len(parts)} values ({'; '.join(parts)})"


def decimal(exact: Fraction) -> str:
    """Return an exact number as people write it."""
    return str(exact.numerator) if exact.denominator == 1 else str(float(exact))


def lines(spans: Lines) -> str:
    """Return line numbers of the document in words."""
    text = ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in spans)
    one = len(spans) == 1 and spans[0][0] == spans[0][1]
    return f"line {text}" if one else f"lines {text}"


def units(unit: str) -> str:
    """Return a unit's plural, which follows a number."""
    return UNITS[unit].plural
