"""Splits messages into single numbers, with their encodings and legal values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from cobotwire_codegen import floats, lower
from cobotwire_codegen.model import (
    BitPart,
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
    Variant,
    Wire,
)
from cobotwire_codegen.render.by_identity import by_identity

RawValues = dict[str, tuple[int, ...]]
"""A message: its raw values by field."""


@dataclass(frozen=True, slots=True)
class Slot:
    """One number of a field. ``choices``, if there are any, are its only legal raw values.

    With ``bits`` it is that many bits of a word, ``shift`` bits above the lowest one; ``more``
    means that the next number is in the same word. A byte of a text is a ``letter``.
    """

    wire: Wire
    scale: Fraction
    lowest: int
    highest: int
    choices: tuple[int, ...]
    bits: int = 0
    shift: int = 0
    more: bool = False
    letter: bool = False
    utf8: bool = False

    @property
    def ends(self) -> tuple[int, int]:
        """The lowest and the highest raw value that vectors use; bytes of UTF-8 are ASCII here."""
        if self.wire.is_float:
            infinity = floats.largest_rank(self.wire.width) + 1
            return max(self.lowest, -1 - infinity), min(self.highest, infinity)
        return self.lowest, min(self.highest, 127) if self.utf8 else self.highest

    @property
    def takes_nan(self) -> bool:
        """Whether it is a float that may be infinite or not a number."""
        return self.wire.is_float and self.highest > floats.largest_rank(self.wire.width)

    def allows(self, raw: int) -> bool:
        """Return whether the edition allows a raw value."""
        return raw in self.choices if self.choices else self.lowest <= raw <= self.highest

    def value(self, raw: int) -> int | float | str:
        """Return the physical value of a raw value; as text if JSON has no such number."""
        if self.wire.is_float:
            infinity = floats.largest_rank(self.wire.width) + 1
            if -1 - infinity < raw < infinity:
                value = float(floats.exact_of(raw, self.wire.width))
                return -0.0 if raw == -1 else value
            return {infinity: "Infinity", -1 - infinity: "-Infinity"}.get(raw, "NaN")
        exact = raw * self.scale
        return raw if self.scale == 1 else float(exact)

    @property
    def step(self) -> int:
        """The number of bytes from here to the next number."""
        return 0 if self.more else self.wire.width

    def encode(self, raw: int, word: bytes = b"") -> bytes:
        """Return the bytes of a raw value, in the word that has the parts before this one."""
        if not self.bits:
            return self.wire.bytes_of(raw)
        others = int.from_bytes(word, self.wire.order)
        own = raw % (1 << self.bits) << self.shift
        return (others | own).to_bytes(self.wire.width, self.wire.order)

    def encodable(self, raw: int) -> bool:
        """Return whether some bytes decode to a raw value, legal or not."""
        if self.wire.is_float:
            half = int(256**self.wire.width) // 2
            return -half <= raw < half
        if self.bits:
            return self.read(self.encode(raw)) == raw
        return self.wire.minimum <= raw <= self.wire.maximum

    def read(self, data: bytes) -> int:
        """Return the raw value of bytes."""
        if not self.bits:
            return self.wire.raw_of(data)
        word = int.from_bytes(data, self.wire.order) >> self.shift & ((1 << self.bits) - 1)
        return word if word <= self.wire.signed_at else word - (1 << self.bits)


def slots(field: Field, variant: Variant, raw_values: RawValues) -> tuple[Slot, ...] | None:
    """Return a field's numbers in a message; None if its selector picks no case."""
    if not field.selector:
        return _own_slots(field)
    picked = raw_values[field.selector][0]
    for when, type in lower.cases(field):
        if picked in when:
            return _slots(field, type)
    return None


def case_choices(variant: Variant) -> Iterator[dict[str, int]]:
    """Yield the selector values for each case; one empty entry if there are no cases."""
    pickers = [field for field in variant if field.selector]
    if not pickers:
        yield {}
    for field in pickers:
        for when, _ in lower.cases(field):
            yield {field.selector: when[0]}


def bad_text_at(field: Field, raw_values: tuple[int, ...]) -> int | None:
    """Return the index of the first byte that is not text in UTF-8, or None."""
    type = field.type.of if isinstance(field.type, Listed) else field.type
    if not isinstance(type, Chars) or type.encoding != "utf-8":
        return None
    size = type.size if isinstance(field.type, Listed) else len(raw_values)
    for at in range(0, len(raw_values), size or 1):
        try:
            bytes(raw_values[at : at + size]).decode()
        except UnicodeDecodeError as error:
            return at + error.start
    return None


def texts(field: Field, raw_values: tuple[int, ...]) -> str | list[str] | None:
    """Return the text of a field, a list of texts, or None if the field is neither."""
    listed = isinstance(field.type, Listed)
    type = field.type.of if isinstance(field.type, Listed) else field.type
    if not isinstance(type, Chars):
        return None
    size = type.size if listed else len(raw_values)
    pad = b"" if type.padding is None else bytes([type.padding])
    found = []
    for at in range(0, len(raw_values) if listed else 1, size or 1):
        data = bytes(raw_values[at : at + size])
        found.append((data.rstrip(pad) if pad else data).decode(type.encoding))
    return found if listed else found[0]


@by_identity
def _own_slots(field: Field) -> tuple[Slot, ...]:
    return _slots(field, field.type)


def _slots(field: Field, type: Type) -> tuple[Slot, ...]:
    return _of_type(type, None if field.const is None else (field.const,))


def _of_type(type: Type, const: tuple[int, ...] | None = None) -> tuple[Slot, ...]:
    if isinstance(type, Value):
        return tuple(_quantity(item, item.choices) for _, item in type.items)
    if isinstance(type, Bits):
        return tuple(_bit_slot(part, part is type.bit_parts[-1]) for part in type.bit_parts)
    if isinstance(type, Listed):
        return _of_type(type.of) * type.least
    if isinstance(type, Octets | Chars):
        top = type.byte["maximum"]
        letter = isinstance(type, Chars)
        utf8 = isinstance(type, Chars) and type.encoding == "utf-8"
        slot = Slot(type.wire, Fraction(1), 0, top, (), letter=letter, utf8=utf8)
        return (slot,) * type.least
    choices = type.choices if const is None else const
    if isinstance(type, Quantity):
        return (_quantity(type, choices),)
    assert isinstance(type, Enum | Flag)
    return (Slot(type.wire, Fraction(1), min(choices), max(choices), choices),)


def _bit_slot(part: BitPart, last: bool) -> Slot:
    [slot] = _of_type(part.type)
    return replace(slot, bits=part.count, shift=part.shift, more=not last)


def _quantity(type: Quantity, choices: tuple[int, ...]) -> Slot:
    lowest, highest = type.bounds
    if type.not_finite:
        half = 256**type.wire.width // 2
        return Slot(type.wire, type.scale, -half, half - 1, choices)
    return Slot(type.wire, type.scale, int(lowest), int(highest), choices)
