"""Define the checks that detect damaged frames: sums, XOR, Fletcher's checksums, and CRCs."""

from __future__ import annotations

from functools import cache
from typing import Literal, NamedTuple

ByteOrder = Literal["big", "little"]
Algorithm = Literal["sum", "inverted-sum", "negated-sum", "xor", "fletcher", "fletcher-16", "crc"]
CoveredFrom = Literal["header", "address", "length", "command", "data"]


class Crc(NamedTuple):
    """The parameters of a CRC, as in Greg Cook's catalogue (the Rocksoft model)."""

    width: int
    poly: int
    init: int
    refin: bool
    refout: bool
    xorout: int

    def of(self, data: bytes) -> int:
        """Return the CRC of some bytes."""
        steps, mask = _steps(self.width, self.poly, self.refin), (1 << self.width) - 1
        if self.refin:
            crc = _reversed(self.init, self.width)
            for byte in data:
                crc = crc >> 8 ^ steps[(crc ^ byte) & 0xFF]
        else:
            # At least 8 bits, so that a whole byte can be added.
            spare = max(0, 8 - self.width)
            crc, top, mask = self.init << spare, self.width + spare - 8, mask << spare
            for byte in data:
                crc = (crc << 8 & mask) ^ steps[crc >> top ^ byte]
            crc >>= spare
        if self.refin != self.refout:
            crc = _reversed(crc, self.width)
        return crc ^ self.xorout


@cache
def _steps(width: int, poly: int, refin: bool) -> tuple[int, ...]:
    """Return the effect of each byte on a CRC."""
    return tuple([_step(byte, width, poly, refin) for byte in range(256)])


def _step(byte: int, width: int, poly: int, refin: bool) -> int:
    if refin:
        poly = _reversed(poly, width)
        for _ in range(8):
            byte = byte >> 1 ^ poly if byte & 1 else byte >> 1
        return byte
    spare = max(0, 8 - width)
    width, poly = width + spare, poly << spare
    crc, mask = byte << width - 8, (1 << width) - 1
    for _ in range(8):
        crc = (crc << 1 ^ poly if crc >> width - 1 else crc << 1) & mask
    return crc


def _reversed(value: int, width: int) -> int:
    return int(f"{value:0{width}b}"[::-1], 2)


class Check(NamedTuple):
    """A number of ``width`` bytes that is computed from the frame.

    It covers all bytes from the part ``covers_from`` to the end of the data. In a
    Fletcher checksum, the second sum is the high half.
    """

    algorithm: Algorithm
    covers_from: CoveredFrom
    width: int = 1
    order: ByteOrder = "big"
    crc: Crc | None = None

    def of(self, covered: bytes) -> bytes:
        """Return the bytes of the check."""
        return self._number(covered).to_bytes(self.width, self.order)

    def _number(self, covered: bytes) -> int:
        if self.crc is not None:
            return self.crc.of(covered)
        if self.algorithm == "xor":
            result = 0
            for byte in covered:
                result ^= byte
            return result
        if self.algorithm in ("fletcher", "fletcher-16"):
            return _fletcher(covered, 256 if self.algorithm == "fletcher" else 255)
        total = sum(covered)
        if self.algorithm == "inverted-sum":
            total = ~total
        elif self.algorithm == "negated-sum":
            total = -total
        return total & (1 << 8 * self.width) - 1


def _fletcher(covered: bytes, modulus: int) -> int:
    first = second = 0
    for byte in covered:
        first = (first + byte) % modulus
        second = (second + first) % modulus
    return second << 8 | first
