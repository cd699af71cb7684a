"""Numbers on the wire, and where the end of the arm is."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable

# Standard DH: offset and alpha in degrees, a and d in millimetres.
LINKS = (
    (0, 90, 0, 131.22),
    (-90, 0, -110.4, 0),
    (0, 0, -96, 0),
    (-90, 90, 0, 64.62),
    (90, -90, 0, 73.18),
    (0, 0, 0, 48.6),
)
COORDS = (10, 10, 10, 100, 100, 100)
ANGLES = (100,) * 6
Matrix = list[list[float]]


def framed(id: int, body: bytes) -> bytes:
    """Return a frame with the right LEN."""
    return b"\xfe\xfe" + bytes([len(body) + 2, id]) + body + b"\xfa"


def packed(numbers: Iterable[int]) -> bytes:
    """Return numbers as big-endian words."""
    return b"".join(struct.pack(">H", number & 0xFFFF) for number in numbers)


def words(numbers: Iterable[float], scales: Iterable[float]) -> bytes:
    """Return numbers as big-endian words, each times its scale."""
    return packed(round(n * s) for n, s in zip(numbers, scales))


def signed(data: bytes) -> list[int]:
    """Return big-endian words; those above 33000 are negative."""
    raws = struct.unpack(f">{len(data) // 2}H", data)
    return [raw - 65536 if raw > 33000 else raw for raw in raws]


def product(a: Matrix, b: Matrix) -> Matrix:
    """Return the product of two matrices."""
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def flange(angles: Iterable[float]) -> Matrix:
    """Return the flange's frame as a matrix."""
    found = [[float(row == column) for column in range(4)] for row in range(4)]
    for angle, (offset, alpha, a, d) in zip(angles, LINKS):
        t, al = math.radians(angle + offset), math.radians(alpha)
        ct, st, ca, sa = math.cos(t), math.sin(t), math.cos(al), math.sin(al)
        link = [
            [ct, -st * ca, st * sa, a * ct],
            [st, ct * ca, -ct * sa, a * st],
            [0.0, sa, ca, float(d)],
            [0.0, 0.0, 0.0, 1.0],
        ]
        found = product(found, link)
    return found


def coords(m: Matrix) -> list[float]:
    """Return x, y, z, rx, ry, rz of a frame, in millimetres and degrees."""
    ry = math.atan2(-m[2][0], math.hypot(m[0][0], m[1][0]))
    rx, rz = math.atan2(m[2][1], m[2][2]), math.atan2(m[1][0], m[0][0])
    return [m[0][3], m[1][3], m[2][3], *map(math.degrees, (rx, ry, rz))]
