"""Builds frames from the model with exact arithmetic: the third, independent encoder.

The codecs interpret the generated table; this one reads the spec's own model, so a mistake in
between shows as a vector that does not hold.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Literal

from cobotwire_codegen.model import Command, Enum, Field, Flag, Frame, Quantity, Type, Value, Wire


def build_frame(
    frame: Frame,
    command: Command,
    direction: Literal["request", "reply"],
    values: dict[str, object],
) -> bytes:
    """The frame that carries ``values``.

    Raises:
        ValueError: the message has no such form, or a value cannot be said.
    """
    for form in command.forms(direction):
        if [field.name for field in form] == list(values):
            break
    else:
        raise ValueError(f"no {direction} of {command.name} has the fields {', '.join(values)}")
    data = b"".join(_field(field, values) for field in form)
    return frame.header + bytes([2 + len(data), command.id]) + data + frame.footer


def _field(field: Field, values: dict[str, object]) -> bytes:
    type = field.type
    if field.by:
        picked = values[field.by]
        type = next((case for member, case in field.cases if member.name == picked), field.type)
    return say(type, field.name, values[field.name])


def say(type: Type, name: str, value: object) -> bytes:
    """One value of a type as bytes."""
    if isinstance(type, Value):
        if not isinstance(value, tuple) or len(value) != len(type.items):
            raise ValueError(f"{name} must be a list of {len(type.items)} numbers")
        return b"".join(
            say(item, f"{name}.{label}", part) for (label, item), part in zip(type.items, value)
        )
    if isinstance(type, Enum):
        for member in type.members:
            if member.name == value:
                return _word(type.wire, Fraction(member.value), name)
        raise ValueError(f"{name} must be one of {', '.join(m.name for m in type.members)}")
    if isinstance(type, Flag):
        if not isinstance(value, bool):
            raise ValueError(f"{name} must be true or false")
        return _word(type.wire, Fraction(int(value)), name)
    return _quantity(type, name, value)


def _quantity(type: Quantity, name: str, value: object) -> bytes:
    if isinstance(value, bool) or not isinstance(value, int | Fraction):
        raise ValueError(f"{name} must be a number")
    whole = Fraction(value) / type.scale
    lowest, highest = type.bounds
    if not lowest <= whole <= highest:
        raise ValueError(
            f"{name} is {value}, outside {lowest * type.scale}..{highest * type.scale}"
        )
    return _word(type.wire, whole, name)


def _word(wire: Wire, whole: Fraction, name: str) -> bytes:
    if whole.denominator != 1:
        raise ValueError(f"{name} falls between two steps of the wire")
    return int(whole % 256**wire.width).to_bytes(wire.width, wire.order)


def size(type: Type) -> int:
    """Bytes of a type on the wire."""
    if isinstance(type, Value):
        return sum(item.wire.width for _, item in type.items)
    return type.wire.width
