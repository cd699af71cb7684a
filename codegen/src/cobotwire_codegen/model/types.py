"""What a field can be: numbers on the wire, quantities, enums, flags, named tuples."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model.facts import Dispute, Lines


@dataclass(frozen=True, slots=True)
class Wire:
    """How a whole number stands on the wire."""

    place: Place
    name: str
    width: int
    order: Literal["big", "little"]
    signed_at: int
    doc: str
    source: Lines
    disputed: tuple[Dispute, ...]

    @property
    def minimum(self) -> int:
        """The lowest whole number that it can say."""
        return self.signed_at + 1 - 256**self.width if self.signed_at < self.top else 0

    @property
    def maximum(self) -> int:
        """The highest whole number that it can say."""
        return self.signed_at

    @property
    def top(self) -> int:
        """The highest raw word."""
        return int(256**self.width) - 1


@dataclass(frozen=True, slots=True)
class Quantity:
    """A wire type with a scale, a unit and a range (in that unit; None: all that can be said).

    ``choices`` closes the list of legal numbers on the wire. With ``radians`` the API speaks
    radians where the wire carries degrees.
    """

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

    @property
    def bounds(self) -> tuple[Fraction, Fraction]:
        """The range as whole numbers on the wire; with a denominator of 1 if it can be said."""
        if self.choices:
            return Fraction(min(self.choices)), Fraction(max(self.choices))
        if self.range is None:
            return Fraction(self.wire.minimum), Fraction(self.wire.maximum)
        return self.range[0] / self.scale, self.range[1] / self.scale


@dataclass(frozen=True, slots=True)
class Member:
    """One value of an enum."""

    place: Place
    name: str
    value: int
    doc: str


@dataclass(frozen=True, slots=True)
class Enum:
    """A closed list of values."""

    place: Place
    name: str
    class_name: str
    wire: Wire
    members: tuple[Member, ...]
    doc: str
    source: Lines


@dataclass(frozen=True, slots=True)
class Flag:
    """Yes or no, as 1 or 0."""

    place: Place
    name: str
    wire: Wire
    doc: str


@dataclass(frozen=True, slots=True)
class Value:
    """Several quantities that belong together: a named tuple."""

    place: Place
    name: str
    class_name: str
    items: tuple[tuple[str, Quantity], ...]
    doc: str


Type = Quantity | Enum | Flag | Value
