"""Turns nodes of ``types.yaml`` into wire types, quantities, flags, enums and values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Literal

from cobotwire_codegen import language
from cobotwire_codegen.build.parts import Named
from cobotwire_codegen.encodings import ENCODINGS
from cobotwire_codegen.errors import Place, Problem, nearest
from cobotwire_codegen.language.meanings import in_words
from cobotwire_codegen.language.records import Key
from cobotwire_codegen.load import Node, Scalar
from cobotwire_codegen.model import (
    BitPart,
    Bits,
    Chars,
    Dispute,
    Enum,
    Evidence,
    Flag,
    Listed,
    Member,
    Octets,
    Quantity,
    Type,
    Value,
    Wire,
)
from cobotwire_codegen.reader import Reader


def stand_in(place: Place) -> Quantity:
    """Return a harmless type in place of one that is wrong, so that reading can continue."""
    wire = Wire(place, "byte", 1, "big", 255, "", (), ())
    return Quantity(place, "", wire, Fraction(1), "", None, (), False, "", (), ())


class Types:
    """Every type of an edition by name. Looking up an unknown name reports a problem."""

    def __init__(self, sections: dict[str, Named], problems: list[Problem]) -> None:
        self._problems = problems
        self.wires = {
            name: self._wire(name, place, node) for name, (place, node) in sections["wire"].items()
        }
        self.types: dict[str, Type] = {}
        makers: tuple[tuple[str, Callable[[str, Place, Node], Type]], ...] = (
            ("quantities", self._quantity),
            ("flags", self._flag),
            ("enums", self._enum),
            ("values", self._value),
            ("bits", self._bits),
            ("bytes", self._octets),
            ("texts", self._chars),
            ("lists", self._listed),
        )
        for section, make in makers:
            for name, (place, node) in sections[section].items():
                self.types[name] = make(name, place, node)

    def find(self, name: str, place: Place) -> Type:
        """Return the type called ``name``."""
        if name in self.types:
            return self.types[name]
        hint = nearest(name, self.types)
        self._problems.append(Problem(place, "unknown-type", f"there is no type {name}{hint}"))
        return stand_in(place)

    def _wire(self, name: str, place: Place, node: Node) -> Wire:
        spec = language.Wire
        reader = Reader(node, spec, f"the wire type {name}", self._problems)
        width = reader.get(spec.bytes)
        encoding = reader.get(spec.encoding)
        rule = ENCODINGS[encoding]
        kind = f"the wire type {name} is {rule.what}"
        if width not in rule.widths:
            message = f"{kind} of {width} bytes; allowed: {rule.allowed}"
            reader.problem("bad-width", message, reader.place_of(spec.bytes))
            width = 4
        if not rule.has_sign_rule and reader.node(spec.signed_at) is not None:
            message = f"{kind}; remove its signed_at"
            reader.problem("bad-sign", message, reader.place_of(spec.signed_at))
        top = 256**width - 1 if rule.has_sign_rule else 0
        signed_at = top if reader.node(spec.signed_at) is None else reader.get(spec.signed_at)
        if signed_at > top:
            message = f"signed_at of the wire type {name} is {signed_at}; allowed: 0..{top}"
            reader.problem("bad-sign", message, reader.place_of(spec.signed_at))
            signed_at = top
        return Wire(
            place,
            name,
            width,
            "little" if reader.get(spec.order) == "little" else "big",
            signed_at,
            reader.get(spec.doc),
            reader.get(spec.source),
            disputes(reader, spec.disputed),
            encoding,
        )

    def _integer(self, reader: Reader, key: Key[str]) -> Wire:
        """Return a wire type that must be an integer."""
        wire = self._named_wire(reader, key)
        if wire.encoding != "integer":
            message = f"{reader.what} is encoded as {wire.rule.what}; choose an integer"
            reader.problem("bad-float", message, reader.place_of(key))
        return wire

    def _named_wire(self, reader: Reader, key: Key[str]) -> Wire:
        name = reader.get(key)
        if name in self.wires:
            return self.wires[name]
        if name:
            message = f"there is no wire type {name}{nearest(name, self.wires)}"
            reader.problem("unknown-wire", message, reader.place_of(key))
        return stand_in(reader.place).wire

    def _quantity(self, name: str, place: Place, node: Node) -> Quantity:
        spec = language.Quantity
        reader = Reader(node, spec, f"the quantity {name}", self._problems)
        quantity = Quantity(
            place,
            name,
            self._named_wire(reader, spec.wire),
            reader.get(spec.scale),
            reader.get(spec.unit),
            reader.get(spec.range),
            reader.get(spec.choices),
            reader.get(spec.shown_in) == "radian",
            " ".join(filter(None, (reader.get(spec.doc), in_words(reader.get(spec.meanings))))),
            reader.get(spec.source),
            disputes(reader, spec.disputed),
            reader.get(spec.not_finite),
            reader.get(spec.meanings),
        )
        if quantity.meanings and quantity.real:
            message = f"the quantity {name} has meanings; make it an integer without a scale"
            reader.problem("bad-meaning", message)
        self._check_float(quantity, reader)
        if quantity.choices and (quantity.range is not None or quantity.scale != 1):
            message = f"the quantity {name} has choices; remove its range and its scale"
            reader.problem("bad-choices", message)
        if quantity.radians and quantity.unit != "degree":
            message = f"the quantity {name} is shown in radians, so its unit must be degree"
            reader.problem("bad-unit", message)
        return quantity

    def _check_float(self, quantity: Quantity, reader: Reader) -> None:
        """Report keys of a float that only an integer may have, and the reverse."""
        name, is_float = quantity.name, quantity.wire.is_float
        if is_float and (quantity.scale != 1 or quantity.choices):
            message = f"the quantity {name} is a float; remove its scale and its choices"
            reader.problem("bad-float", message)
        if quantity.not_finite and (quantity.range is not None or not is_float):
            message = f"the quantity {name} can be not_finite only as a float without a range"
            reader.problem("bad-float", message)

    def _flag(self, name: str, place: Place, node: Node) -> Flag:
        spec = language.Flag
        reader = Reader(node, spec, f"the flag {name}", self._problems)
        return Flag(place, name, self._integer(reader, spec.wire), reader.get(spec.doc))

    def _enum(self, name: str, place: Place, node: Node) -> Enum:
        spec = language.Enum
        reader = Reader(node, spec, f"the enum {name}", self._problems)
        return Enum(
            place,
            name,
            reader.get(spec.class_),
            self._integer(reader, spec.wire),
            tuple(self._member(name, *entry) for entry in reader.get(spec.members)),
            reader.get(spec.doc),
            reader.get(spec.source),
        )

    def _member(self, enum: str, name: str, place: Place, node: Node) -> Member:
        spec = language.Member
        reader = Reader(node, spec, f"the member {name} of {enum}", self._problems)
        return Member(
            place, name, reader.get(spec.value), reader.get(spec.doc), reader.get(spec.falsy)
        )

    def _value(self, name: str, place: Place, node: Node) -> Value:
        spec = language.Value
        reader = Reader(node, spec, f"the value type {name}", self._problems)
        items = []
        for item, where, content in reader.get(spec.items):
            type = self.find(plain_name(content), where)
            if not isinstance(type, Quantity):
                reader.problem("bad-item", f"{item} of {name} must be a quantity", where)
                type = stand_in(where)
            items.append((item, type))
        return Value(place, name, reader.get(spec.class_), tuple(items), reader.get(spec.doc))

    def _bits(self, name: str, place: Place, node: Node) -> Bits:
        spec = language.Bits
        reader = Reader(node, spec, f"the bits {name}", self._problems)
        wire = self._integer(reader, spec.wire)
        parts: list[BitPart] = []
        used = 0
        for part, where, content in reader.get(spec.parts):
            inner = Reader(content, language.BitPart, f"{part} of {name}", self._problems)
            low, high = inner.get(language.BitPart.bits)
            mask = (1 << high + 1) - (1 << low)
            if high >= 8 * wire.width or mask & used:
                message = f"{part} of {name} exceeds its wire type, or overlaps another part"
                reader.problem("bad-size", message, where)
                continue
            used |= mask
            parts.append(BitPart(part, low, high - low + 1, self._bit_type(inner, wire, where)))
        parts.sort(key=lambda part: part.shift)
        return Bits(place, name, reader.get(spec.class_), wire, tuple(parts), reader.get(spec.doc))

    def _bit_type(self, reader: Reader, wire: Wire, place: Place) -> Quantity | Enum | Flag:
        spec = language.BitPart
        low, high = reader.get(spec.bits)
        doc, enum = reader.get(spec.doc), reader.get(spec.enum)
        top = (1 << high - low + 1) - 1
        signed_at = top // 2 if reader.get(spec.signed) else top
        own = replace(wire, place=place, signed_at=signed_at)
        if enum:
            found = self.find(enum, reader.place_of(spec.enum))
            fits = all(0 <= member.value <= top for member in found.members)
            if isinstance(found, Enum) and fits:
                return replace(found, wire=own)
            message = f"{enum} of {reader.what} is not an enum with values 0..{top}"
            reader.problem("bad-item", message, reader.place_of(spec.enum))
        if low == high and not reader.get(spec.signed):
            return Flag(place, "", own, doc)
        ends = Fraction(signed_at - top if signed_at < top else 0), Fraction(signed_at)
        return Quantity(place, "", own, Fraction(1), "", ends, (), False, doc, (), ())

    def _octets(self, name: str, place: Place, node: Node) -> Octets:
        spec = language.Octets
        reader = Reader(node, spec, f"the bytes {name}", self._problems)
        least, most = reader.get(spec.size)
        return Octets(place, name, least, most, reader.get(spec.doc))

    def _chars(self, name: str, place: Place, node: Node) -> Chars:
        spec = language.Chars
        reader = Reader(node, spec, f"the text {name}", self._problems)
        least, most = reader.get(spec.size)
        padding, word = reader.get(spec.padding), reader.get(spec.encoding)
        if padding >= 0 and (least < most or padding > 127):
            message = f"the padded text {name} must have a fixed size, and an ASCII padding byte"
            reader.problem("bad-size", message, reader.place_of(spec.padding))
        encoding: Literal["ascii", "utf-8", "latin-1"] = "ascii"
        if word != "ascii":
            encoding = "utf-8" if word == "utf-8" else "latin-1"
        pad = padding if padding >= 0 else None
        return Chars(place, name, least, most, encoding, pad, reader.get(spec.doc))

    def _listed(self, name: str, place: Place, node: Node) -> Listed:
        spec = language.Listed
        reader = Reader(node, spec, f"the list {name}", self._problems)
        of = self.find(reader.get(spec.of), reader.place_of(spec.of))
        if isinstance(of, Bits | Octets | Listed) or (
            isinstance(of, Chars) and (of.varies or of.least < 2)
        ):
            message = (
                f"the list {name} cannot have elements of the type {of.name}; allowed: a quantity, "
                "flag, enum, value type, or text of a fixed size of at least 2 bytes"
            )
            reader.problem("bad-item", message, reader.place_of(spec.of))
            of = stand_in(place)
        least, most = reader.get(spec.size)
        return Listed(place, name, of, least, most, reader.get(spec.doc))


def plain_name(node: Node) -> str:
    """Return the name that a node holds; empty if it holds none."""
    return str(node.value) if isinstance(node, Scalar) else ""


def disputes(reader: Reader, key: Key[tuple[Node, ...]]) -> tuple[Dispute, ...]:
    """Return the disputes that a type or command lists under a key."""
    spec = language.Dispute
    found = []
    for node in reader.get(key):
        inner = Reader(node, spec, f"a dispute of {reader.what}", reader.problems)
        found.append(
            Dispute(
                node.place,
                inner.get(spec.claim),
                inner.get(spec.reading),
                inner.get(spec.confidence),
                evidence(inner, spec.evidence),
                inner.get(spec.about),
            )
        )
    return tuple(found)


def evidence(reader: Reader, key: Key[tuple[Node, ...]]) -> tuple[Evidence, ...]:
    """Return the evidence that a dispute or change lists under a key."""
    spec = language.Evidence
    inner = [
        Reader(node, spec, f"a piece of evidence of {reader.what}", reader.problems)
        for node in reader.get(key)
    ]
    return tuple(
        Evidence(one.get(spec.source), one.get(spec.lines), one.get(spec.says)) for one in inner
    )
