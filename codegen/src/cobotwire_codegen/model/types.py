"""Defines the types of numbers: quantity, enum, flag, and a value type of several quantities.

All four have the same attributes, so that the rest of the generator rarely distinguishes them:
``kind``, ``name``, ``doc``, ``class_name``, ``members``, ``items``, ``parts``, ``size``,
``choices``, and the conversions ``from_raw`` and ``read``. A type also describes itself:
``numbers`` for the table, ``span`` in words, ``stated`` as its record in ``edition.json``, and
``scalar`` as the Python type of its value or of each of its numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar

from cobotwire_codegen import floats
from cobotwire_codegen.errors import Place
from cobotwire_codegen.model.facts import Dispute, Lines
from cobotwire_codegen.model.wires import Wire
from cobotwire_codegen.units import UNITS

Record = dict[str, Any]
# Returns the name of a type or wire type; or its record, if the edition's lists lack it.
Refer = Callable[[Any], str | Record]


class _Scalar:
    """What quantities, enums and flags have in common: one raw value."""

    __slots__ = ()
    items: ClassVar[tuple[tuple[str, Scalar], ...]] = ()
    name: str
    wire: Wire

    @property
    def numbers(self) -> tuple[Record, ...]:
        """Its one number in the table."""
        assert isinstance(self, Enum | Flag)
        return (number_of(self.wire, min(self.choices), max(self.choices)),)

    @property
    def parts(self) -> tuple[tuple[str, Scalar], ...]:
        """The scalars that make up the type, by name: just this one."""
        assert isinstance(self, Quantity | Enum | Flag)
        return (("", self),)

    @property
    def size(self) -> int:
        """Bytes on the wire."""
        return self.wire.width

    @property
    def sizes(self) -> tuple[int, int]:
        """The smallest and the largest number of elements."""
        return 1, 1

    @property
    def varies(self) -> bool:
        """Whether values differ in their number of elements."""
        return False

    @property
    def element_size(self) -> int:
        """Bytes on the wire."""
        return self.size

    def read(self, data: bytes) -> object:
        """Return the value that bytes encode, as a vector writes it."""
        assert isinstance(self, Quantity | Enum | Flag)
        return self.from_raw(self.wire.raw_of(data))

    def can_hold(self, raw: int) -> bool:
        """Return whether the wire type can encode a raw value."""
        return self.wire.minimum <= raw <= self.wire.maximum

    def can_hold_any(self, width: int) -> bool:
        """Return whether every raw value of a width is legal."""
        return False

    def narrowed(self, ends: tuple[Fraction, Fraction]) -> Quantity | None:
        """Return the type with a narrower range; None if the type cannot have that range."""
        return None

    def values(self, most: int) -> tuple[Member, ...]:
        """Return the legal values as members; nothing if there are more than ``most``."""
        return ()


@dataclass(frozen=True)  # without slots, for the cached property
class Quantity(_Scalar):
    """A wire type with a scale, a unit and a range (in that unit; None: every raw value).

    ``choices``, if there are any, are the only legal raw values. ``meanings`` are a first and a
    last raw value, and what those in between stand for; raw values without a meaning are legal too.
    With ``radians`` the API uses radians, and the wire carries degrees.
    """

    kind: ClassVar[str] = "quantity"
    class_name: ClassVar[str] = ""
    members: ClassVar[tuple[Member, ...]] = ()

    place: Place
    name: str
    wire: Wire
    scale: Fraction
    unit: str
    range: tuple[Fraction, Fraction] | None
    choices: tuple[int, ...]
    radians: bool
    doc: str
    source: Lines
    disputed: tuple[Dispute, ...]
    not_finite: bool = False
    meanings: tuple[tuple[int, int, str], ...] = ()

    @property
    def scalar(self) -> str:
        """The Python type of its value."""
        return "float" if self.real else "int"

    @property
    def numbers(self) -> tuple[Record, ...]:
        """Its one number in the table."""
        lowest, highest = self.bounds
        if self.not_finite:
            half = 256**self.wire.width // 2
            lowest, highest = Fraction(-half), Fraction(half - 1)
        number = number_of(self.wire, int(lowest), int(highest))
        number |= {"multiply": self.scale.numerator, "divide": self.scale.denominator}
        number["unit"] = self.unit
        return (number | ({"choices": list(self.choices)} if self.choices else {}),)

    @property
    def span(self) -> str:
        """The allowed values in words."""
        if self.choices:
            return "one of " + ", ".join(map(str, self.choices))
        lowest, highest = self.ends
        units = UNITS[self.unit].plural if self.unit else ""
        unit = f" {units}" if units else ""
        if self.not_finite:
            return f"a number{unit}, also infinity and NaN"
        if self.wire.is_float and self.range is None:
            return f"a finite number of {self.wire.width} bytes{units and f', in {units}'}"
        return f"{decimal(lowest)}..{decimal(highest)}{unit}"

    def stated(self, refer: Refer) -> Record:
        """Return its record in ``edition.json``, without empty values."""
        record: Record = {"wire": refer(self.wire)}
        if self.scale != 1:
            record["scale"] = exact_number(self.scale)
        if self.unit:
            record["unit"] = self.unit
        if self.range is not None:
            record["minimum"], record["maximum"] = map(exact_number, self.bounds)
        elif self.not_finite:
            [number] = self.numbers
            record |= {key: number[key] for key in ("minimum", "maximum")}
        meanings = [{"first": a, "last": b, "says": says} for a, b, says in self.meanings]
        rest = {"choices": list(self.choices), "radians": self.radians, "meanings": meanings}
        rest["doc"] = self.doc
        return record | {key: value for key, value in rest.items() if value}

    @cached_property
    def bounds(self) -> tuple[Fraction, Fraction]:
        """The range as raw values; their denominators are 1 if the wire type can encode them."""
        if self.choices:
            return Fraction(min(self.choices)), Fraction(max(self.choices))
        if self.range is None:
            return Fraction(self.wire.minimum), Fraction(self.wire.maximum)
        low, high = self.range
        if self.wire.is_float:
            width = self.wire.width
            return Fraction(floats.ceiling(low, width)), Fraction(floats.floor(high, width))
        return low / self.scale, high / self.scale

    @property
    def ends(self) -> tuple[Fraction, Fraction]:
        """The range in the unit."""
        if self.range is not None and not self.choices:
            return self.range
        lowest, highest = self.bounds
        return self.exact(lowest), self.exact(highest)

    @property
    def real(self) -> bool:
        """Whether the physical value is a float in Python."""
        return self.wire.is_float or self.scale != 1

    def exact(self, raw: int | Fraction) -> Fraction:
        """Return the physical value of a raw value."""
        if self.wire.is_float:
            return floats.exact_of(int(raw), self.wire.width)
        return raw * self.scale

    def from_raw(self, raw: int) -> object:
        """Return the physical value of a raw value."""
        return _plain(self.exact(raw))

    def can_hold_any(self, width: int) -> bool:
        """Return whether every raw value of a width is legal."""
        plain = self.range is None and not self.choices and not self.wire.is_float
        return self.wire.width == width and plain

    def narrowed(self, ends: tuple[Fraction, Fraction]) -> Quantity | None:
        """Return the quantity with a narrower range; None if the range is not inside this one."""
        lowest, highest = self.ends
        inside = lowest <= ends[0] and ends[1] <= highest and not self.choices
        return replace(self, range=ends) if inside else None

    def values(self, most: int) -> tuple[Member, ...]:
        """Return the legal values as members named by their numbers; nothing if too many."""
        if self.real:
            return ()
        lowest, highest = (int(bound) for bound in self.bounds)
        numbers = self.choices or range(lowest, highest + 1)
        if len(numbers) > most:
            return ()
        return tuple(Member(self.place, str(number), number, "") for number in numbers)


@dataclass(frozen=True, slots=True)
class Member:
    """One value of an enum."""

    place: Place
    name: str
    value: int
    doc: str
    falsy: bool = False


@dataclass(frozen=True, slots=True)
class Enum(_Scalar):
    """A closed list of values."""

    kind: ClassVar[str] = "enum"
    scalar: ClassVar[str] = "int"
    scale: ClassVar[Fraction] = Fraction(1)
    unit: ClassVar[str] = ""

    place: Place
    name: str
    class_name: str
    wire: Wire
    members: tuple[Member, ...]
    doc: str
    source: Lines

    @property
    def choices(self) -> tuple[int, ...]:
        """The legal raw values."""
        return tuple(member.value for member in self.members)

    @property
    def span(self) -> str:
        """The members in words."""
        return "one of " + ", ".join(f"{member.name} ({member.value})" for member in self.members)

    def stated(self, refer: Refer) -> Record:
        """Return its record in ``edition.json``."""
        members = [
            {"name": member.name, "value": member.value, "doc": member.doc}
            for member in self.members
        ]
        record = {"class_name": self.class_name, "wire": refer(self.wire)}
        return record | {"members": members, "doc": self.doc}

    def from_raw(self, raw: int) -> object:
        """Return the name of the member with a raw value, or the raw value as text."""
        names = {member.value: member.name for member in self.members}
        return names.get(raw, str(raw))

    def values(self, most: int) -> tuple[Member, ...]:
        """Return the members."""
        return self.members


@dataclass(frozen=True, slots=True)
class Flag(_Scalar):
    """Yes or no, encoded as 1 or 0."""

    kind: ClassVar[str] = "flag"
    scalar: ClassVar[str] = "bool"
    span: ClassVar[str] = "True or False"
    class_name: ClassVar[str] = ""
    members: ClassVar[tuple[Member, ...]] = ()
    scale: ClassVar[Fraction] = Fraction(1)
    unit: ClassVar[str] = ""
    choices: ClassVar[tuple[int, ...]] = (0, 1)

    place: Place
    name: str
    wire: Wire
    doc: str

    def stated(self, refer: Refer) -> Record:
        """Return its record in ``edition.json``."""
        return {"wire": refer(self.wire), "doc": self.doc}

    def from_raw(self, raw: int) -> object:
        """Return whether a raw value is 1."""
        return raw == 1


@dataclass(frozen=True, slots=True)
class Value:
    """Several quantities that belong together: a named tuple."""

    kind: ClassVar[str] = "value"
    members: ClassVar[tuple[Member, ...]] = ()
    choices: ClassVar[tuple[int, ...]] = ()

    place: Place
    name: str
    class_name: str
    items: tuple[tuple[str, Quantity], ...]
    doc: str

    @property
    def scalar(self) -> str:
        """The Python type of each number."""
        return "float" if any(item.real for _, item in self.items) else "int"

    @property
    def numbers(self) -> tuple[Record, ...]:
        """The numbers of the items, with their names."""
        return tuple(item.numbers[0] | {"name": name} for name, item in self.items)

    @property
    def span(self) -> str:
        """The allowed values in words, each range once."""
        spans: dict[str, list[str]] = {}
        for name, item in self.items:
            spans.setdefault(item.span, []).append(name)
        inner = "; ".join(f"{', '.join(group)} {words}" for words, group in spans.items())
        return f"{len(self.items)} numbers ({inner})"

    def stated(self, refer: Refer) -> Record:
        """Return its record in ``edition.json``."""
        items = [{"name": name, "type": refer(item)} for name, item in self.items]
        return {"class_name": self.class_name, "items": items, "doc": self.doc}

    @property
    def parts(self) -> tuple[tuple[str, Scalar], ...]:
        """The scalars that make up the type, by name."""
        return self.items

    @property
    def size(self) -> int:
        """Bytes on the wire."""
        return sum(item.wire.width for _, item in self.items)

    @property
    def sizes(self) -> tuple[int, int]:
        """The smallest and the largest number of elements."""
        return 1, 1

    @property
    def varies(self) -> bool:
        """Whether values differ in their number of elements."""
        return False

    @property
    def element_size(self) -> int:
        """Bytes on the wire."""
        return self.size

    def read(self, data: bytes) -> object:
        """Return the values that bytes encode, one for each item."""
        values = []
        for _, item in self.items:
            values.append(item.read(data[: item.size]))
            data = data[item.size :]
        return tuple(values)

    def can_hold(self, raw: int) -> bool:
        """Return False: a value type has several raw values."""
        return False

    def can_hold_any(self, width: int) -> bool:
        """Return False: a value type has several raw values."""
        return False

    def narrowed(self, ends: tuple[Fraction, Fraction]) -> None:
        """Return None: a value type has no range of its own."""

    def values(self, most: int) -> tuple[Member, ...]:
        """Return nothing: a value type cannot be a selector."""
        return ()


def _plain(exact: Fraction) -> int | Fraction:
    """Return a whole number as an int, any other number as it is."""
    return int(exact) if exact.denominator == 1 else exact


def exact_number(number: Fraction) -> int | str:
    """Return a whole number, or any other number as text: ``1/100``."""
    return number.numerator if number.denominator == 1 else str(number)


def decimal(exact: Fraction) -> str:
    """Return an exact number as people write it."""
    return str(exact.numerator) if exact.denominator == 1 else str(float(exact))


def number_of(wire: Wire, minimum: int, maximum: int) -> Record:
    """Return a number in the table, without a name, a scale and a unit."""
    scale = {"multiply": 1, "divide": 1}
    bounds = {"minimum": minimum, "maximum": maximum, "unit": ""}
    return {"name": "", **wire.form, **scale, **bounds}


Scalar = Quantity | Enum | Flag
