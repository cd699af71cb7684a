"""Define one number on the wire: its bytes, its raw value and its physical value."""

from __future__ import annotations

import struct
from math import inf
from typing import Literal, NamedTuple

from cobotwire.protocol.error_texts import stored_texts

Encoding = Literal["integer", "float"]
# The formats of ``struct``: the float, and the signed integer of its bits.
_FORMATS = {4: ("f", "i"), 8: ("d", "q")}


class Number(NamedTuple):
    """One number on the wire: ``width`` bytes, a sign rule, and a scale as an exact rational.

    The bytes are an unsigned integer ``u``. The raw value is ``u - 256**width`` if
    ``u > signed_at``, else ``u``. The physical value is ``raw * multiply / divide``, a float; where
    ``multiply == divide == 1`` it is the raw value itself, an ``int``.
    ``minimum`` and ``maximum`` bound the raw value.

    With the encoding ``float`` the bytes are an IEEE 754 float of 4 or 8 bytes, without a scale or
    a sign rule. The raw value is the integer of its bits, but the bits after the sign are inverted
    where the sign is set: so the raw values have the order of the floats, with -0.0 (-1) before 0.0
    (0), and bounds apply to them as to those of an integer.

    If ``bits`` is not 0, the number is that many bits of the bytes, ``shift`` bits above the lowest
    one; ``more`` means that the next number is in the same bytes. ``kind``, ``choices`` and
    ``labels`` are set only if they differ from those of the field's other numbers; otherwise the
    field has them.
    """

    name: str
    width: int
    order: Literal["big", "little"]
    signed_at: int
    multiply: int
    divide: int
    minimum: int
    maximum: int
    unit: str
    encoding: Encoding = "integer"
    kind: Literal["number", "flag", "enum"] = "number"
    choices: tuple[int, ...] = ()
    labels: tuple[str, ...] = ()
    shift: int = 0
    bits: int = 0
    more: bool = False

    def alike(self, other: Number) -> bool:
        """Return whether the same bytes hold the same raw value in both numbers."""
        return self._place == other._place

    @property
    def _place(self) -> tuple[object, ...]:
        return self.width, self.order, self.signed_at, self.encoding, self.shift, self.bits

    @property
    def step(self) -> int:
        """The number of bytes from here to the next number of the field."""
        return 0 if self.more else self.width

    def allows(self, raw: int) -> bool:
        """Return whether the number may hold a raw value."""
        return raw in self.choices if self.choices else self.minimum <= raw <= self.maximum

    @property
    def units(self) -> str:
        """The unit as it follows a number, in the plural; empty if the number has no unit."""
        return stored_texts("units.json").get(self.unit, self.unit)

    @property
    def scaled(self) -> bool:
        """Whether the physical value differs from the raw value by a factor."""
        return not self.multiply == self.divide == 1

    @property
    def real(self) -> bool:
        """Whether the physical value is a float (True) or the raw value itself (False)."""
        return self.scaled or self.encoding == "float"

    @property
    def raw_range(self) -> tuple[int, int]:
        """The lowest and the highest raw value that the bytes can hold; floats: finite ones."""
        if self.encoding == "float":
            beyond = raw_of_float(inf, self.width)
            return -beyond, beyond - 1
        top = (1 << (self.bits or 8 * self.width)) - 1
        return (0 if self.signed_at >= top else self.signed_at - top), min(self.signed_at, top)

    @property
    def takes_not_finite(self) -> bool:
        """Whether the bounds allow a float that is infinite or not a number."""
        return self.encoding == "float" and self.maximum > self.raw_range[1]

    def unpack(self, data: bytes, offset: int = 0) -> int:
        """Return the raw value at ``offset``."""
        unsigned = int.from_bytes(data[offset : offset + self.width], self.order)
        if self.encoding == "float":
            return _ordered(unsigned, self.width)
        if self.bits:
            unsigned = (unsigned >> self.shift) & ((1 << self.bits) - 1)
            return unsigned - (1 << self.bits) if unsigned > self.signed_at else unsigned
        return unsigned - 256**self.width if unsigned > self.signed_at else unsigned

    def pack(self, raw: int) -> bytes:
        """Return the bytes of a raw value: its lowest ``width`` bytes if it does not fit."""
        if self.bits:
            raw = raw % (1 << self.bits) << self.shift
        elif self.encoding == "float" and raw < 0:
            raw ^= 256**self.width // 2 - 1
        return (raw % (1 << 8 * self.width)).to_bytes(self.width, self.order)

    def physical(self, raw: int) -> int | float:
        """Return the physical value of a raw value."""
        if self.encoding == "float":
            return float_of_raw(raw, self.width)
        return raw * self.multiply / self.divide if self.scaled else raw

    def steps(self, physical: float) -> float:
        """Return the raw value of a physical value, not yet rounded to an integer.

        Each operation uses IEEE doubles, so that all codecs encode the same bytes.
        """
        return physical * self.divide / self.multiply

    def raw(self, physical: float) -> int:
        """Return the raw value nearest to a physical value; ties go to the even one."""
        if self.encoding == "float":
            return raw_of_float(physical, self.width)
        return round(self.steps(physical)) if self.scaled else int(physical)

    def clamp(self, raw: int) -> int:
        """Return ``raw``, limited to the bounds of the number."""
        return min(max(raw, self.minimum), self.maximum)


def raw_of_float(value: float, width: int) -> int:
    """Return the raw value of the nearest float of ``width`` bytes: infinity if it is too large."""
    real, bits = _FORMATS[width]
    if value != value:  # one NaN for all, since a payload does not survive every conversion
        return 0x7FC0_0000 if width == 4 else 0x7FF8_0000_0000_0000
    try:
        packed = struct.pack(real, value)
    except OverflowError:
        packed = struct.pack(real, inf if value > 0 else -inf)
    signed: int = struct.unpack(bits, packed)[0]
    return signed if signed >= 0 else signed ^ (256**width // 2 - 1)


def float_of_raw(raw: int, width: int) -> float:
    """Return the float of a raw value."""
    real, bits = _FORMATS[width]
    signed = raw if raw >= 0 else raw ^ (256**width // 2 - 1)
    value: float = struct.unpack(real, struct.pack(bits, signed))[0]
    return value


def _ordered(unsigned: int, width: int) -> int:
    half = 256**width // 2
    return unsigned if unsigned < half else (unsigned - 2 * half) ^ (half - 1)
