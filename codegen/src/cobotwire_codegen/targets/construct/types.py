"""Expresses types as calls of construct's classes, and of the functions in the template."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from cobotwire_codegen.model import (
    Bits,
    Chars,
    Enum,
    Field,
    Flag,
    Listed,
    Octets,
    Quantity,
    Type,
    Value,
    floats,
)
from cobotwire_codegen.render.literal import Call, Name, literal

Declaration = Call | Name
# The names of the template, which no type may have.
_TAKEN = frozenset({"HEADER", "FOOTER", "ADDRESS", "LENGTH", "COMMAND", "CHECK", "MESSAGES"})


class Types:
    """The numbers and words of an edition; equal ones are declared once, by their type's name."""

    def __init__(self) -> None:
        self.declared: dict[str, Call] = {}
        self._names: dict[str, str] = {}

    def of(self, field: Field, type: Type, count: Name | int) -> Declaration:
        """Return the declaration of a field with ``count`` elements, if the type is a list."""
        if isinstance(type, Octets):
            return Call("Bytes", count)
        if isinstance(type, Chars):
            return _text(type, count)
        if isinstance(type, Listed):
            return Call("Array", count, self._element(type))
        if field.const is not None and not isinstance(type, Value | Bits):
            return Call("Const", _constant(type, field.const), self._constant_type(field, type))
        return self._single(type)

    def _single(self, type: Quantity | Enum | Flag | Value | Bits) -> Declaration:
        if isinstance(type, Value):
            parts = {label: self._declare(item) for label, item in type.items}
            return Call("Struct", **parts)
        return self._declare(type)

    def _element(self, type: Listed) -> Declaration:
        if isinstance(type.of, Chars):
            return _text(type.of, type.of.size)
        return self._single(type.of)

    def _constant_type(self, field: Field, type: Quantity | Enum | Flag) -> Declaration:
        """Return a number that holds a constant, which need not be inside of its type's range."""
        assert field.const is not None, "the field is a constant"
        if isinstance(type, Quantity) and type.wire.is_float:
            return self._declare(type)
        if isinstance(type, Enum) and field.const in type.choices:
            return self._declare(type)
        return _number(type, (field.const,))

    def _declare(self, type: Quantity | Enum | Flag | Bits) -> Name:
        """Return the name under which a number or a word is declared."""
        expression = _expression(type)
        text = literal(expression)
        if text not in self._names:
            name, count = type.name.upper(), 1
            while name in _TAKEN or name in self.declared:
                count += 1
                name = f"{type.name.upper()}_{count}"
            self._names[text] = name
            self.declared[name] = expression
        return Name(self._names[text])


def _constant(type: Quantity | Enum | Flag, raw: int) -> int | float | str:
    """Return a constant as the declaration of its type reads it."""
    if isinstance(type, Enum):
        return next((member.name for member in type.members if member.value == raw), raw)
    return _plain(type.exact(raw), type.real) if isinstance(type, Quantity) else raw


def _plain(exact: Fraction, real: bool) -> int | float:
    return float(exact) if real else int(exact)


def _expression(type: Quantity | Enum | Flag | Bits) -> Call:
    if isinstance(type, Bits):
        return _bits(type)
    if isinstance(type, Quantity):
        return _float(type) if type.wire.is_float else _number(type, type.choices)
    return _named(type, _number(type, type.choices))


def _named(type: Enum | Flag | Quantity, number: Call) -> Call:
    """Return a number with the names of its values."""
    if isinstance(type, Flag):
        return Call("flag", number)
    if isinstance(type, Enum):
        return Call("Enum", number, **{member.name: member.value for member in type.members})
    return number


def _number(type: Quantity | Enum | Flag, choices: tuple[int, ...]) -> Call:
    """Return an integer that may hold the choices; without any, those of the quantity's range."""
    allowed: Any = choices or Call("between", *map(int, type.bounds))  # type: ignore[union-attr]
    wire = type.wire
    scale = (type.scale.numerator, type.scale.denominator)
    arguments = (wire.width, wire.order == "little", wire.signed_at, allowed)
    return Call("number", *arguments, *(scale * (scale != (1, 1))))


def _float(type: Quantity) -> Call:
    wire = type.wire
    name = Name(f"Float{8 * wire.width}{'l' if wire.order == 'little' else 'b'}")
    if type.not_finite:
        return Call("real", name)
    ends = (float(floats.exact_of(int(raw), wire.width)) for raw in type.bounds)
    return Call("real", name, *ends)


def _bits(type: Bits) -> Call:
    """Return a word by its parts, the highest one first, with the bits that have no name."""
    parts: list[tuple[str, Any]] = []
    top = 8 * type.wire.width
    for part in reversed(type.bit_parts):
        if above := top - part.shift - part.count:
            parts.append(("", Call("Padding", above)))
        signed = part.type.wire.signed_at < (1 << part.count) - 1
        raw = Call("BitsInteger", part.count, **({"signed": True} if signed else {}))
        if isinstance(part.type, Enum | Flag):
            raw = _named(part.type, Call("OneOf", raw, part.type.choices))
        parts.append((part.name, raw))
        top = part.shift
    if top:
        parts.append(("", Call("Padding", top)))
    return Call("word", type.wire.order == "little", *parts)


def _text(type: Chars, count: Name | int) -> Call:
    padding = () if type.padding is None else (type.padding,)
    return Call("text", count, type.encoding, *padding)
