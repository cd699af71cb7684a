"""Position and orientation in space. Orientation: R = Rz(rz) Ry(ry) Rx(rx)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

Vector = tuple[float, float, float]
NOWHERE: Vector = (0.0, 0.0, 0.0)
# Below this cosine of ry, rx and rz turn about the same axis.
UPRIGHT = 1e-9


class Pose(NamedTuple):
    """A frame in another frame: its three axes, and its origin in millimetres."""

    x: Vector
    y: Vector
    z: Vector
    origin: Vector

    @classmethod
    def of(cls, coords: Sequence[float]) -> Pose:
        """Return the pose of six coordinates: x y z in millimetres, rx ry rz in degrees."""
        (cx, sx), (cy, sy), (cz, sz) = (_cos_sin(angle) for angle in coords[3:])
        return cls(
            (cz * cy, sz * cy, -sy),
            (cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx),
            (cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx),
            (coords[0], coords[1], coords[2]),
        )

    @property
    def coords(self) -> tuple[float, ...]:
        """The six coordinates: x y z in millimetres, then degrees: rx, rz -180..180, ry -90..90."""
        (xx, xy, xz), (_, yy, yz), (_, zy, zz), origin = self
        rx, ry, rz = math.atan2(yz, zz), math.atan2(-xz, math.hypot(xx, xy)), math.atan2(xy, xx)
        if math.hypot(xx, xy) < UPRIGHT:
            # Here rx and rz turn about the same axis; rounding would decide how they share it.
            rx, rz = math.atan2(-zy, yy), 0.0
        return (*origin, math.degrees(rx), math.degrees(ry), math.degrees(rz))

    def then(self, other: Pose) -> Pose:
        """Return, in the outer frame, the pose that is ``other`` in this frame."""
        x, y, z = (self.direction(axis) for axis in other[:3])
        ox, oy, oz = self.direction(other.origin)
        px, py, pz = self.origin
        return Pose(x, y, z, (px + ox, py + oy, pz + oz))

    def direction(self, v: Vector) -> Vector:
        """Return, in the outer frame, a direction of this frame."""
        (ax, ay, az), (bx, by, bz), (cx, cy, cz), _ = self
        p, q, r = v
        return ax * p + bx * q + cx * r, ay * p + by * q + cy * r, az * p + bz * q + cz * r

    def inverted(self) -> Pose:
        """Return the outer frame in this frame."""
        x, y, z = zip(self.x, self.y, self.z)
        px, py, pz = Pose(x, y, z, NOWHERE).direction(self.origin)
        return Pose(x, y, z, (-px, -py, -pz))

    def distance(self, other: Pose) -> tuple[float, float]:
        """Return the distance of two poses in millimetres, and the turn between them in degrees."""
        chord = math.hypot(
            *(a - b for one, two in zip(self[:3], other[:3]) for a, b in zip(one, two))
        )
        # The Frobenius norm of the difference is sqrt(8) sin(turn / 2): exact for small turns too.
        turn = 2 * math.asin(min(chord / math.sqrt(8), 1.0))
        return math.dist(self.origin, other.origin), math.degrees(turn)


def cross(one: Vector, other: Vector) -> Vector:
    """Return the cross product of two vectors."""
    (ax, ay, az), (bx, by, bz) = one, other
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def turned_about(axis: int, degrees: float) -> Pose:
    """Return a turn about an axis of the outer frame: 0 x, 1 y, 2 z."""
    coords = [0.0] * 6
    coords[3 + axis] = degrees
    return Pose.of(coords)


def _cos_sin(degrees: float) -> tuple[float, float]:
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
