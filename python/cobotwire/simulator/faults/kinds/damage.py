"""Faults that change bytes into others."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.simulator.faults.fault import Context, Damage
from cobotwire.simulator.faults.registry import kind
from cobotwire.simulator.faults.rules import integer, optional, pairs_of_hex, ruled


@kind("corrupted")
@dataclass(frozen=True, slots=True, kw_only=True)
class Corrupted(Damage):
    """Bits are flipped.

    Attributes:
        bits: how many different bits.
        byte: the index of the byte in which all bits are flipped, counted from 0, or from the end
            if negative; None: the bits are in any bytes.
    """

    bits: int = ruled(integer(1, 64), 1)
    byte: int | None = ruled(optional(integer(-4096, 4095)), None)

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Flip the bits; if there is no such byte, change nothing."""
        places = range(8 * len(data))
        if self.byte is not None:
            places = range(8 * (self.byte % len(data)), 8 * (self.byte % len(data)) + 8)
            if not -len(data) <= self.byte < len(data):
                return data
        chosen = sorted(context.random.sample(places, min(self.bits, len(places))))
        spoilt = bytearray(data)
        for place in chosen:
            spoilt[place // 8] ^= 1 << place % 8
        flipped = ", ".join(f"bit {place % 8} of byte {place // 8}" for place in chosen)
        context.report(f"{flipped} of the {self.of} flipped")
        return bytes(spoilt)


@kind("wrong-length")
@dataclass(frozen=True, slots=True, kw_only=True)
class WrongLength(Damage):
    """The frame's LEN is wrong.

    Attributes:
        by: how much larger it is than the right one; negative: smaller.
    """

    by: int = ruled(integer(-255, 255), 1)

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Change LEN of the first frame."""
        frame = context.frame
        if not data.startswith(frame.header) or len(data) < frame.head_size:
            return data
        right = frame.read_length(data)
        spoilt = frame.with_length(data, right + self.by)
        context.report(f"LEN {frame.read_length(spoilt)} in place of {right}")
        return spoilt


@kind("wrong-id")
@dataclass(frozen=True, slots=True, kw_only=True)
class WrongId(Damage):
    """The frame has another command's id.

    Attributes:
        id: which id; None: any other, at random.
    """

    id: int | None = ruled(optional(integer(0, 0xFFFF)), None)

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Change the id of the first frame; replies of some formats carry none."""
        frame = context.frame
        if not data.startswith(frame.header) or len(data) < frame.head_size:
            return data
        if not frame.has_id(self.of):
            return data
        right = frame.read_id(data)
        other = right + context.random.randrange(1, 256**frame.id_number.width)
        spoilt = frame.with_id(data, other if self.id is None else self.id)
        context.report(f"id 0x{frame.read_id(spoilt):02X} in place of 0x{right:02X}")
        return spoilt


@kind("replaced")
@dataclass(frozen=True, slots=True, kw_only=True)
class Replaced(Damage):
    """Other bytes come instead.

    Attributes:
        by: the other bytes.
    """

    by: bytes = ruled(pairs_of_hex, b"\xfe\xfe\x03\x12\x01\xfa")

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Return the other bytes."""
        context.report(f"{self.by.hex(' ').upper()} in place of the {self.of}")
        return self.by
