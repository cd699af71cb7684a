"""Decides how the values of a field lie in the struct of its message."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from cobotwire_codegen import lower
from cobotwire_codegen.model import Bits, Chars, Field, Listed, Octets, Quantity, Type, Value
from cobotwire_codegen.model.shapes import Shaped
from cobotwire_codegen.targets.c import names

Kind = Literal["RAW", "FLOAT", "DOUBLE", "BYTE"]
# The member of the union `number_t` that holds a number of each kind.
_UNION = {"RAW": "raw", "FLOAT": "single", "DOUBLE": "real"}


@dataclass(frozen=True, slots=True)
class Leaf:
    """One number of an element: its encoding on the wire, and its offset in the element.

    ``access`` follows the element in C; ``place`` is a C expression for the offset in bytes.
    """

    number: dict[str, Any]
    kind: Kind
    access: str
    place: str


@dataclass(frozen=True, slots=True)
class Storage:
    """How a field is stored: elements of one C type, with the numbers of each case of the field.

    A list has between ``least`` and ``most`` elements; each consists of the numbers of its case,
    ``each`` times. Other fields have one element.
    """

    element: str
    dimensions: tuple[int, ...]
    least: int
    most: int
    each: int
    cases: tuple[tuple[Leaf, ...], ...]
    general: bool

    @property
    def varies(self) -> bool:
        """Whether messages differ in the number of elements."""
        return self.least < self.most

    @property
    def count(self) -> int:
        """The largest possible count of numbers."""
        return self.most * self.each * max(map(len, self.cases))


def storage(prefix: str, field: Field) -> Storage:
    """Return how a field is stored; ``prefix`` starts every name of the edition."""
    types = [type for _, type in lower.cases(field)]
    if len(types) == 1 and isinstance(types[0], Shaped):
        return _shaped(prefix, types[0])
    general = any(_has_float(type) for type in types)
    if len(types) > 1 and general:
        cases = tuple(_in_union(prefix, type) for type in types)
        return Storage(f"{prefix}_number_t", (max(map(len, cases)),), 1, 1, 1, cases, True)
    cases = tuple(_leaves(prefix, type, general) for type in types)
    if isinstance(types[0], Value) and general:
        return Storage(group_name(prefix, types[0]), (), 1, 1, 1, cases, True)
    element = c_type(prefix, cases[0][0].kind)
    dimensions = (max(map(len, cases)),) if isinstance(field.type, Value) else ()
    return Storage(element, dimensions, 1, 1, 1, cases, general)


def _shaped(prefix: str, type: Type) -> Storage:
    if isinstance(type, Bits):
        leaves = _leaves(prefix, type, True)
        return Storage(group_name(prefix, type), (), 1, 1, 1, (leaves,), True)
    least, most = type.sizes
    if isinstance(type, Octets | Chars):
        leaf = Leaf(type.byte, "BYTE", "", "0")
        element = "char" if isinstance(type, Chars) else "uint8_t"
        return Storage(element, (max(most, 1),), least, most, 1, ((leaf,),), True)
    assert isinstance(type, Listed)
    if isinstance(type.of, Chars):
        inner = _shaped(prefix, type.of)
        dimensions = (max(most, 1), *inner.dimensions)
        return Storage(inner.element, dimensions, least, most, inner.most, inner.cases, True)
    leaves = _leaves(prefix, type.of, True)
    grouped = isinstance(type.of, Value)
    element = group_name(prefix, type.of) if grouped else c_type(prefix, leaves[0].kind)
    return Storage(element, (max(most, 1),), least, most, 1, (leaves,), True)


def c_type(prefix: str, kind: Kind) -> str:
    """Return the C type of a number."""
    return {"FLOAT": "float", "DOUBLE": "double", "BYTE": "uint8_t"}.get(kind, f"{prefix}_raw_t")


def group_name(prefix: str, type: Type) -> str:
    """Return the name of the struct for a value type or for bits."""
    return f"{prefix}_{type.name}_value_t"


def group_of(field: Field) -> Value | Bits | None:
    """Return the type that has a struct of its own in this field."""
    type = field.type.of if isinstance(field.type, Listed) else field.type
    if isinstance(type, Bits):
        return type
    if not isinstance(type, Value) or len(list(lower.cases(field))) > 1:
        return None
    return type if isinstance(field.type, Listed) or _has_float(type) else None


def kind_of(number: dict[str, Any]) -> Kind:
    """Return how a number outside a text is stored."""
    if number.get("encoding") != "float":
        return "RAW"
    return "FLOAT" if number["width"] == 4 else "DOUBLE"


def _leaves(prefix: str, type: Type, in_struct: bool) -> tuple[Leaf, ...]:
    found = []
    for index, number in enumerate(type.numbers):
        access, place = "", "0"
        if isinstance(type, Value | Bits) and in_struct:
            member = names.member(number["name"])
            access, place = f".{member}", f"offsetof({group_name(prefix, type)}, {member})"
        elif isinstance(type, Value):
            access, place = f"[{index}]", f"{index} * sizeof({prefix}_raw_t)"
        found.append(Leaf(number, kind_of(number), access, place))
    return tuple(found)


def _in_union(prefix: str, type: Type) -> tuple[Leaf, ...]:
    return tuple(
        Leaf(
            number,
            kind_of(number),
            f"[{index}].{_UNION[kind_of(number)]}",
            f"{index} * sizeof({prefix}_number_t)",
        )
        for index, number in enumerate(type.numbers)
    )


def _has_float(type: Type) -> bool:
    parts = [item for _, item in type.items] if isinstance(type, Value) else [type]
    return any(isinstance(part, Quantity) and part.wire.is_float for part in parts)
