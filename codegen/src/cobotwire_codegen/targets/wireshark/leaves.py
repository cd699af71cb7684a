"""Turns types into leaves: the numbers, texts and bytes that the dissector reads and shows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from cobotwire_codegen.model import Bits, Chars, Enum, Flag, Listed, Octets, Quantity, Type
from cobotwire_codegen.render.words import units


class Leaf(NamedTuple):
    """One number, text or byte string.

    ``kind`` is a name of Wireshark's ``ftypes``. ``mask`` selects the bits of a bit field within
    its raw value; it is 0 for any other leaf. ``reading`` has the parameters with which the
    dissector reads the leaf.
    """

    item: str
    kind: str
    mask: int
    words: tuple[tuple[int, str], ...]
    unit: str
    doc: str
    reading: dict[str, Any]


def leaves(type: Type) -> list[Leaf]:
    """Return the leaves of a type in the order of the wire.

    For a list, the leaves of one element.
    """
    if isinstance(type, Listed):
        return leaves(type.of)
    if isinstance(type, Octets | Chars):
        kind = "STRING" if isinstance(type, Chars) else "BYTES"
        return [Leaf("", kind, 0, (), "", "", {"width": 1})]
    if isinstance(type, Bits):
        return list(_bits(type))
    return list(_numbers(type))


def group_kind(type: Type) -> str:
    """Return the kind of the field that groups the leaves of a type; empty: they have no group."""
    if isinstance(type, Bits):
        return f"UINT{8 * type.wire.width}"
    inner = type.of if isinstance(type, Listed) else type
    return "NONE" if inner.kind == "value" else ""


def _numbers(type: Type) -> Iterator[Leaf]:
    assert not isinstance(type, Bits | Octets | Chars | Listed), "these have leaves of their own"
    for number, (_, part) in zip(type.numbers, type.parts):
        reading = _reading(number)
        if isinstance(part, Quantity):
            if part.wire.is_float:
                reading = _float(reading, part)
            reading |= {"choices": list(part.choices)} if part.choices else {}
            reading |= {"meanings": list(part.meanings)} if part.meanings else {}
        unit = units(number["unit"]) if number["unit"] else ""
        yield Leaf(number["name"], _kind(type, number), 0, _words(part), unit, "", reading)


def _reading(number: dict[str, Any]) -> dict[str, Any]:
    """Return what the dissector needs to know to read a number."""
    keys = ("name", "width", "order", "signed_at", "minimum", "maximum", "unit")
    reading = {key: number[key] for key in keys if number[key] != ""}
    if "unit" in reading:
        reading["unit"] = units(reading["unit"])
    if (number["multiply"], number["divide"]) != (1, 1):
        reading |= {"multiply": number["multiply"], "divide": number["divide"]}
    return reading


def _float(reading: dict[str, Any], type: Quantity) -> dict[str, Any]:
    """Return a float's reading. Its bounds are physical, since Lua cannot hold all raw values."""
    del reading["minimum"], reading["maximum"], reading["signed_at"]
    bounds = {} if type.not_finite else dict(zip(("minimum", "maximum"), type.bounds))
    exact = {key: float(type.exact(raw)) for key, raw in bounds.items()}
    return reading | exact | {"encoding": "float"}


def _bits(type: Bits) -> Iterator[Leaf]:
    for number, part in zip(type.numbers, type.bit_parts):
        reading = _reading(number) | {"shift": part.shift, "bits": part.count}
        if isinstance(part.type, Flag | Enum):
            # The list says which values are legal.
            reading["choices"] = number["choices"]
            del reading["minimum"], reading["maximum"]
        if isinstance(part.type, Flag):
            reading["flag"] = True
        if isinstance(part.type, Enum):
            reading["labels"] = dict(_words(part.type))
        if number["more"]:
            reading["more"] = True
        signed = number["signed_at"] < (1 << part.count) - 1
        kind = f"{'INT' if signed else 'UINT'}{8 * type.wire.width}"
        mask = ((1 << part.count) - 1) << part.shift
        kind = "BOOLEAN" if isinstance(part.type, Flag) else kind
        yield Leaf(part.name, kind, mask, _words(part.type), "", part.type.doc, reading)


def _kind(type: Type, number: dict[str, Any]) -> str:
    if isinstance(type, Flag):
        return "BOOLEAN"
    if number.get("encoding") == "float":
        return "FLOAT" if number["width"] == 4 else "DOUBLE"
    if (number["multiply"], number["divide"]) != (1, 1):
        return "DOUBLE"
    if number["signed_at"] == 256 ** number["width"] - 1:
        return "UINT32"
    # An unusual sign rule may need more than 32 bits.
    return "INT32" if number["signed_at"] < 2**31 else "INT64"


def _words(type: Type) -> tuple[tuple[int, str], ...]:
    return tuple((m.value, m.name) for m in type.members) if isinstance(type, Enum) else ()
