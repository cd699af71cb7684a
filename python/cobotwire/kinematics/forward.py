"""Forward kinematics as the firmware computes them: the frames of the links, from the base on.

Numbers have double precision. Pure Python is fast enough for a hundred calls per second.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cobotwire.kinematics.geometry import Geometry
from cobotwire.kinematics.pose import Pose


def flange(geometry: Geometry, angles: Sequence[float]) -> Pose:
    """Return the flange's pose in the frame of the base for ``angles`` in degrees."""
    return frames(geometry, angles)[-1]


def coords_of(geometry: Geometry, angles: Sequence[float]) -> tuple[float, ...]:
    """Return the flange's coordinates: x y z in millimetres, rx ry rz in degrees, not rounded."""
    return flange(geometry, angles).coords


def frames(geometry: Geometry, angles: Sequence[float]) -> list[Pose]:
    """Return the frame after each link, from the base on: the points where links meet."""
    xx, xy, xz, yx, yy, yz, zx, zy, zz = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    px = py = pz = 0.0
    found = []
    for angle, link in zip(geometry.link_angles(angles), geometry.links):
        theta = math.radians(angle + link.offset)
        cos, sin = math.cos(theta), math.sin(theta)
        ca, sa = link.turned
        # Columns of the link's matrix: (c, s, 0), (-s ca, c ca, sa), (s sa, -c sa, ca).
        ux, uy, uz = xx * cos + yx * sin, xy * cos + yy * sin, xz * cos + yz * sin
        vx, vy, vz = yx * cos - xx * sin, yy * cos - xy * sin, yz * cos - xz * sin
        px, py, pz = (
            ux * link.a + zx * link.d + px,
            uy * link.a + zy * link.d + py,
            uz * link.a + zz * link.d + pz,
        )
        xx, xy, xz = ux, uy, uz
        yx, yy, yz, zx, zy, zz = (
            *(vx * ca + zx * sa, vy * ca + zy * sa, vz * ca + zz * sa),
            *(zx * ca - vx * sa, zy * ca - vy * sa, zz * ca - vz * sa),
        )
        found.append(Pose((xx, xy, xz), (yx, yy, yz), (zx, zy, zz), (px, py, pz)))
    return found
