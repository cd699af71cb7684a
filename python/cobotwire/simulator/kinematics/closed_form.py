"""Inverse kinematics in closed form, for arms with the axes of the 280.

They have three parallel joints (the second to the fourth); the axes of the others cross those at
right angles. So a pose has at most eight solutions: two shoulders, two wrists, two elbows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from cobotwire.simulator.kinematics.geometry import Angles, Geometry
from cobotwire.simulator.kinematics.pose import Pose, Vector

# Alpha of each link, in degrees.
SOLVED_AXES = (90, 0, 0, 90, -90, 0)
# Below this sine of the fifth joint, the fourth and the sixth turn about the same axis. Below the
# second sine they nearly do, and the truncation of a pose may decide how far each of them turns.
WRIST_STRAIGHT, WRIST_NEARLY_STRAIGHT = 1e-7, 1e-2
# In that case, the search tries the sixth joint at steps of this many degrees.
WRIST_STEP = 30
ROUNDING = 1e-6


def is_solved(geometry: Geometry) -> bool:
    """Return whether an arm has the axes that :func:`solutions` solves."""
    links = geometry.links
    return (
        not geometry.coupled
        and tuple(link.alpha for link in links) == SOLVED_AXES
        and all(link.a == 0 for link in (links[0], *links[3:]))
        and links[1].d == links[2].d == 0
        and links[1].a != 0 != links[2].a
    )


def solutions(geometry: Geometry, target: Pose, present: Sequence[float]) -> Iterator[Angles]:
    """Yield each solution in degrees, -180..180, without regard to limits.

    If the target is out of reach, yield angles that may come close to it. ``present`` decides
    about the sixth joint where a straight wrist leaves it free.
    """
    for first in _shoulders(geometry, target):
        # The target's axes and origin in the frame of the first joint.
        seen = Pose.of((0, 0, 0, 0, 0, math.degrees(first))).inverted().then(target)
        across = tuple(-axis[1] for axis in seen[:3])
        for side in (1, -1):
            for fifth, sixth in _wrists(geometry, across, side, present):
                for arm in _elbows(geometry, seen, fifth, sixth):
                    thetas = (first, *arm, fifth, sixth)
                    yield tuple(
                        math.remainder(math.degrees(theta) - link.offset, 360)
                        for theta, link in zip(thetas, geometry.links)
                    )


def _shoulders(geometry: Geometry, target: Pose) -> Iterator[float]:
    """Yield both first angles: the wrist lies beside the arm's plane by the fourth offset."""
    reach = geometry.links[5].d
    x, y = (p - reach * axis for p, axis in zip(target.origin[:2], target.z[:2]))
    aside = math.asin(_unit(geometry.links[3].d / max(math.hypot(x, y), ROUNDING)))
    towards = math.atan2(y, x)
    yield towards + aside
    yield towards + math.pi - aside


def _wrists(
    geometry: Geometry, across: tuple[float, ...], side: int, present: Sequence[float]
) -> Iterator[tuple[float, float]]:
    """Yield fifth and sixth angles, from the target's axes across the arm's plane.

    A straight wrist leaves the sixth free: it stays, or turns as far as the limits require.
    """
    u, v, cosine = across
    sine = side * math.hypot(u, v)
    fifth = math.atan2(sine, cosine)
    if abs(sine) > WRIST_STRAIGHT:
        yield fifth, math.atan2(-v * side, u * side)
    if abs(sine) > WRIST_NEARLY_STRAIGHT:
        return
    for turn in range(0, 360, WRIST_STEP):
        yield fifth, math.radians(present[5] + geometry.links[5].offset + turn)


def _elbows(
    geometry: Geometry, seen: Pose, fifth: float, sixth: float
) -> Iterator[tuple[float, float, float]]:
    """Yield the three angles in the arm's plane, with the elbow on either side."""
    upper, lower = geometry.links[1].a, geometry.links[2].a
    turn, x, y = _fourth_frame(geometry, seen, fifth, sixth)
    bend = math.acos(_unit((x * x + y * y - upper**2 - lower**2) / (2 * upper * lower)))
    for elbow in (bend, -bend):
        along, aside = upper + lower * math.cos(elbow), lower * math.sin(elbow)
        second = math.atan2(y, x) - math.atan2(aside, along)
        yield second, elbow, turn - second - elbow


def _fourth_frame(
    geometry: Geometry, seen: Pose, fifth: float, sixth: float
) -> tuple[float, float, float]:
    """Return the angle and the position of the fourth frame in the arm's plane.

    The plane is that of the first frame's x and y: horizontally along the arm, and up.
    """
    cos5, sin5, cos6, sin6 = math.cos(fifth), math.sin(fifth), math.cos(sixth), math.sin(sixth)
    links = geometry.links
    # The fourth frame's x axis and z axis, in the target's frame.
    along: Vector = (cos5 * cos6, -cos5 * sin6, -sin5)
    normal: Vector = (-sin6, -cos6, 0.0)
    ax, _, az = seen.direction(along)
    nx, _, nz = seen.direction(normal)
    px, _, pz = (p - links[5].d * z for p, z in zip(seen.origin, seen.z))
    x = px - links[4].d * nx
    y = pz - links[4].d * nz - links[0].d
    return math.atan2(az, ax), x, y


def _unit(value: float) -> float:
    """Return a sine or cosine; rounding may have moved it slightly outside."""
    return min(max(value, -1.0), 1.0)
