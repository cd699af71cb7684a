"""Nodes of ``types.yaml`` to wire types, quantities, flags, enums and values."""

from __future__ import annotations

from fractions import Fraction

from cobotwire_codegen.errors import Place, Problem, nearest
from cobotwire_codegen.load import Node, Scalar
from cobotwire_codegen.model import (
    CONFIDENCE,
    UNITS,
    Dispute,
    Enum,
    Evidence,
    Flag,
    Member,
    Quantity,
    Type,
    Value,
    Wire,
)
from cobotwire_codegen.reader import Reader


def stand_in(place: Place) -> Quantity:
    """A harmless type in the place of one that is wrong, so that reading can go on."""
    wire = Wire(place, "byte", 1, "big", 255, "", (), ())
    return Quantity(place, "", wire, Fraction(1), "", None, "", (), ())


class Types:
    """Every type of an edition by name; looking one up that is not there is a problem."""

    def __init__(self, root: Node, problems: list[Problem]) -> None:
        self._problems = problems
        self.wires: dict[str, Wire] = {}
        self.types: dict[str, Type] = {}
        reader = Reader(root, "the types file", problems)
        for name, place, node in reader.entries("wire"):
            self.wires[name] = self._wire(name, place, node)
        for name, place, node in reader.entries("quantities"):
            self._add(name, place, self._quantity(name, place, node))
        for name, place, node in reader.entries("flags"):
            self._add(name, place, self._flag(name, place, node))
        for name, place, node in reader.entries("enums"):
            self._add(name, place, self._enum(name, place, node))
        for name, place, node in reader.entries("values"):
            self._add(name, place, self._value(name, place, node))
        reader.done()

    def find(self, name: str, place: Place) -> Type:
        """The type called ``name``."""
        if name in self.types:
            return self.types[name]
        hint = nearest(name, self.types)
        self._problems.append(Problem(place, "unknown-type", f"there is no type {name}{hint}"))
        return stand_in(place)

    def _add(self, name: str, place: Place, type: Type) -> None:
        if name in self.types:
            first = self.types[name].place
            self._problems.append(
                Problem(place, "duplicate-type", f"{name} is a type already, at {first}")
            )
        self.types[name] = type

    def _wire(self, name: str, place: Place, node: Node) -> Wire:
        reader = Reader(node, f"the wire type {name}", self._problems)
        width = reader.integer("bytes")
        if not 1 <= width <= 4:
            reader.problem("bad-width", f"a wire type has 1 to 4 bytes, not {width}")
            width = 1
        top = 256**width - 1
        signed_at = reader.integer("signed_at", top)
        if not 0 <= signed_at <= top:
            reader.problem("bad-sign", f"signed_at must be in 0..{top}")
            signed_at = top
        wire = Wire(
            place,
            name,
            width,
            "little" if reader.one_of("order", ("big", "little"), "big") == "little" else "big",
            signed_at,
            reader.text("doc"),
            reader.lines("source"),
            disputes(reader),
        )
        reader.done()
        return wire

    def _named_wire(self, reader: Reader) -> Wire:
        node = reader.required("wire")
        name = str(node.value) if isinstance(node, Scalar) else ""
        if name in self.wires:
            return self.wires[name]
        if node is not None:
            hint = nearest(name, self.wires)
            reader.problem("unknown-wire", f"there is no wire type {name}{hint}", node.place)
        return stand_in(reader.place).wire

    def _quantity(self, name: str, place: Place, node: Node) -> Quantity:
        reader = Reader(node, f"the quantity {name}", self._problems)
        quantity = Quantity(
            place,
            name,
            self._named_wire(reader),
            reader.fraction("scale", Fraction(1)),
            reader.one_of("unit", UNITS, ""),
            reader.range("range"),
            reader.text("doc"),
            reader.lines("source"),
            disputes(reader),
        )
        reader.done()
        return quantity

    def _flag(self, name: str, place: Place, node: Node) -> Flag:
        reader = Reader(node, f"the flag {name}", self._problems)
        flag = Flag(place, name, self._named_wire(reader), reader.text("doc"))
        reader.done()
        return flag

    def _enum(self, name: str, place: Place, node: Node) -> Enum:
        reader = Reader(node, f"the enum {name}", self._problems)
        members = []
        for member, where, content in reader.entries("members"):
            inner = Reader(content, f"the member {member} of {name}", self._problems)
            members.append(Member(where, member, inner.integer("value"), inner.text("doc")))
            inner.done()
        enum = Enum(
            place,
            name,
            reader.text("class"),
            self._named_wire(reader),
            tuple(members),
            reader.text("doc"),
            reader.lines("source"),
        )
        reader.done()
        if not members:
            reader.problem("empty-enum", f"the enum {name} has no members")
        return enum

    def _value(self, name: str, place: Place, node: Node) -> Value:
        reader = Reader(node, f"the value {name}", self._problems)
        items = []
        for item, where, content in reader.entries("items"):
            kind = str(content.value) if isinstance(content, Scalar) else ""
            type = self.find(kind, where)
            if not isinstance(type, Quantity):
                reader.problem("bad-item", f"{item} of {name} must be a quantity", where)
                type = stand_in(where)
            items.append((item, type))
        value = Value(place, name, reader.text("class"), tuple(items), reader.text("doc"))
        reader.done()
        if not items:
            reader.problem("empty-value", f"the value {name} has no items")
        return value


def disputes(reader: Reader) -> tuple[Dispute, ...]:
    """The ``disputed`` list of a type or command."""
    found = []
    for node in reader.items("disputed"):
        inner = Reader(node, f"a dispute of {reader.what}", reader.problems)
        evidence = []
        for item in inner.items("evidence"):
            source = Reader(item, "a piece of evidence", reader.problems)
            evidence.append(
                Evidence(source.text("source"), source.lines("lines"), source.text("says"))
            )
            source.done()
        dispute = Dispute(
            node.place,
            inner.text("claim"),
            inner.text("reading"),
            inner.one_of("confidence", CONFIDENCE),
            tuple(evidence),
        )
        inner.done()
        if not evidence:
            inner.problem("no-evidence", "a disputed fact must carry its evidence")
        found.append(dispute)
    return tuple(found)
