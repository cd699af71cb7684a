"""Defines the types that are more than a number: bits of a word, bytes, text, and lists.

They have the attributes of the other types, so that the rest of the generator rarely distinguishes
them. ``sizes`` are the smallest and the largest number of elements of a value; the elements of a
text are its bytes.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, Literal

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model.types import (
    Enum,
    Flag,
    Member,
    Quantity,
    Record,
    Refer,
    Scalar,
    Value,
    number_of,
)
from cobotwire_codegen.model.wires import Wire


class Shaped:
    """What these types have in common: no single raw value, no range, no members."""

    __slots__ = ()
    members: ClassVar[tuple[Member, ...]] = ()
    choices: ClassVar[tuple[int, ...]] = ()
    kind: ClassVar[str]
    name: str
    class_name: str

    @property
    def parts(self) -> tuple[tuple[str, Scalar], ...]:
        """Empty: no value of these types can be a selector, a constant or a default."""
        return ()

    @property
    def sizes(self) -> tuple[int, int]:
        """The smallest and the largest number of elements."""
        return 1, 1

    @property
    def element_size(self) -> int:
        """Bytes of an element on the wire."""
        return 1

    @property
    def size(self) -> int:
        """The smallest number of bytes on the wire."""
        return self.sizes[0] * self.element_size

    @property
    def varies(self) -> bool:
        """Whether values differ in their number of elements."""
        return self.sizes[0] < self.sizes[1]

    @property
    def size_words(self) -> str:
        """The number of elements, or its range, in words."""
        least, most = self.sizes
        return f"{least}..{most}" if self.varies else str(most)

    def from_raw(self, raw: int) -> object:
        """Return the raw value itself."""
        return raw

    def read(self, data: bytes) -> object:
        """Return the bytes as hex digits, which is how a draft shows them."""
        return data.hex(" ")

    def can_hold(self, raw: int) -> bool:
        """Return False: a value of the type is not a single number."""
        return False

    def can_hold_any(self, width: int) -> bool:
        """Return False: a value of the type is not a single number."""
        return False

    def narrowed(self, ends: tuple[Fraction, Fraction]) -> None:
        """Return None: the type has no range."""

    def values(self, most: int) -> tuple[Member, ...]:
        """Return nothing: the type cannot be a selector."""
        return ()


@dataclass(frozen=True, slots=True)
class BitPart:
    """Some bits of a word: ``count`` bits, ``shift`` bits above the lowest one."""

    name: str
    shift: int
    count: int
    type: Quantity | Enum | Flag


@dataclass(frozen=True, slots=True)
class Bits(Shaped):
    """A word divided into named parts: a named tuple."""

    kind: ClassVar[str] = "bits"
    scalar: ClassVar[str] = "int"

    place: Place
    name: str
    class_name: str
    wire: Wire
    bit_parts: tuple[BitPart, ...]
    doc: str

    @property
    def numbers(self) -> tuple[Record, ...]:
        """The numbers of the parts."""
        return tuple(
            {
                **part.type.numbers[0],
                "name": part.name,
                "kind": part.type.kind if isinstance(part.type, Enum | Flag) else "number",
                "choices": list(part.type.choices),
                "labels": [member.name for member in part.type.members],
                "shift": part.shift,
                "bits": part.count,
                "more": part is not self.bit_parts[-1],
            }
            for part in self.bit_parts
        )

    @property
    def span(self) -> str:
        """The parts with their values in words."""
        parts = [f"{name} {part.span}" for name, part in self.items]
        return f"{len(parts)} values ({'; '.join(parts)})"

    def stated(self, refer: Refer) -> Record:
        """Return its record in ``edition.json``."""
        numbers = list(self.numbers)
        return {"class_name": self.class_name, "numbers": numbers, "doc": self.doc}

    @property
    def element_size(self) -> int:
        """Bytes of the word."""
        return self.wire.width

    @property
    def items(self) -> tuple[tuple[str, Quantity | Enum | Flag], ...]:
        """The parts by name."""
        return tuple((part.name, part.type) for part in self.bit_parts)


class _Sized(Shaped):
    """What types with a number of elements have in common."""

    __slots__ = ()
    class_name: ClassVar[str] = ""  # type: ignore[misc]  # only bits have a class
    items: ClassVar[tuple[tuple[str, Scalar], ...]] = ()
    least: int
    most: int

    @property
    def sizes(self) -> tuple[int, int]:
        """The smallest and the largest number of elements."""
        return self.least, self.most


class _Bytes(_Sized):
    """What bytes and texts have in common: each element is a byte."""

    __slots__ = ()
    place: Place

    @property
    def wire(self) -> Wire:
        """How each byte is encoded."""
        return Wire(self.place, "byte", 1, "big", 255, "A byte.", (), ())

    @property
    def byte(self) -> Record:
        """The number of each byte."""
        return number_of(self.wire, 0, 255)

    @property
    def numbers(self) -> tuple[Record, ...]:
        """The numbers of the shortest value: one for each byte."""
        return (self.byte,) * self.least


@dataclass(frozen=True, slots=True)
class Octets(_Bytes):
    """Bytes without a meaning of their own."""

    kind: ClassVar[str] = "bytes"
    scalar: ClassVar[str] = "bytes"

    place: Place
    name: str
    least: int
    most: int
    doc: str

    @property
    def span(self) -> str:
        """How many bytes, in words."""
        return f"{self.size_words} bytes"

    def stated(self, refer: Refer) -> Record:
        """Return its record in ``edition.json``."""
        return {"least": self.least, "most": self.most, "doc": self.doc}


@dataclass(frozen=True, slots=True)
class Chars(_Bytes):
    """Text inside a frame. With ``padding`` a shorter text is followed by that byte."""

    kind: ClassVar[str] = "text"
    scalar: ClassVar[str] = "str"

    place: Place
    name: str
    least: int
    most: int
    encoding: Literal["ascii", "utf-8", "latin-1"]
    padding: int | None
    doc: str

    @property
    def byte(self) -> Record:
        """The number of each of its bytes."""
        return number_of(self.wire, 0, 127 if self.encoding == "ascii" else 255)

    @property
    def span(self) -> str:
        """The encoding and how many bytes, in words."""
        at_most = "at most " if self.padding is not None else ""
        return f"{self.encoding} text of {at_most}{self.size_words} bytes"

    def stated(self, refer: Refer) -> Record:
        """Return its record in ``edition.json``."""
        padding = {} if self.padding is None else {"padding": self.padding}
        sizes = {"least": self.least, "most": self.most}
        return {**sizes, "encoding": self.encoding, **padding, "doc": self.doc}


@dataclass(frozen=True, slots=True)
class Listed(_Sized):
    """Elements of one type: scalars, value types, or texts of a fixed size."""

    kind: ClassVar[str] = "list"

    place: Place
    name: str
    of: Quantity | Enum | Flag | Value | Chars
    least: int
    most: int
    doc: str

    @property
    def wire(self) -> Wire:
        """How the elements' first number is encoded."""
        return self.of.wire if isinstance(self.of, Chars) else self.of.parts[0][1].wire

    @property
    def scalar(self) -> str:
        """The Python type of an element, or of each of its numbers."""
        return self.of.scalar

    @property
    def numbers(self) -> tuple[Record, ...]:
        """The numbers of the shortest list."""
        return self.of.numbers * self.least

    @property
    def span(self) -> str:
        """How many elements of which values, in words."""
        return f"{self.size_words} elements: {self.of.span}"

    def stated(self, refer: Refer) -> Record:
        """Return its record in ``edition.json``."""
        sizes = {"least": self.least, "most": self.most}
        return {"of": refer(self.of), **sizes, "doc": self.doc}

    @property
    def element_size(self) -> int:
        """Bytes of an element on the wire."""
        return self.of.size


Type = Quantity | Enum | Flag | Value | Bits | Octets | Chars | Listed
