"""Inverse kinematics in closed form, for arms with the axes of the 280, the 320 or the mechArm.

The second and the third joint are parallel, and the first crosses the second at a right angle. On
the 280 and the 320 the fourth joint is parallel to them too. The axes of the fifth and the sixth
each intersect the axis before them at a right angle. On the mechArm the last three axes meet in one
point. So a pose has at most eight solutions: two shoulders, two wrists, two elbows.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from cobotwire.kinematics.geometry import Angles, Geometry
from cobotwire.kinematics.pose import Pose, Vector

# Alpha of each link, in degrees, of the three arms. If the fourth frame is turned by 180 degrees
# about its x axis, the 320 has the form of the 280: the fifth joint then turns in the opposite
# direction, and its offset has the opposite sign.
AXES_280 = (90, 0, 0, 90, -90, 0)
AXES_320 = (90, 0, 0, -90, 90, 0)
AXES_SPHERICAL = (-90, 0, -90, 90, -90, 0)
# Below this sine of the fifth joint, the fourth and the sixth turn about the same axis. Below the
# second sine the two axes are nearly the same, and the truncation of a pose may decide how far each
# joint turns.
WRIST_STRAIGHT, WRIST_NEARLY_STRAIGHT = 1e-7, 1e-2
# In that case, the search tries the sixth joint at steps of this many degrees.
WRIST_STEP = 30
ROUNDING = 1e-6


def is_solved(geometry: Geometry) -> bool:
    """Return whether an arm has axes that :func:`solutions` solves."""
    links = geometry.links
    if geometry.coupled or len(links) != 6 or 0 in (links[1].a, links[2].a):
        return False
    if any(link.a for link in (links[0], *links[3:])) or links[1].d or links[2].d:
        return False
    axes = tuple(link.alpha for link in links)
    return axes in (AXES_280, AXES_320) or (axes == AXES_SPHERICAL and links[4].d == 0)


def solutions(geometry: Geometry, target: Pose, present: Sequence[float]) -> Iterator[Angles]:
    """Yield each solution in degrees, -180..180, without regard to limits.

    If the target is out of reach, yield angles that may come close to it. Solutions with shoulder,
    wrist and elbow as in the ``present`` angles come first. If the wrist is straight, the sixth
    joint is free, and solutions with its present angle come first.
    """
    links = geometry.links
    spherical = links[2].alpha != 0
    now = [math.radians(angle + link.offset) for angle, link in zip(present, links)]
    shoulders = _in_line(geometry, target) if spherical else _beside(geometry, target)
    for first in _nearest_first(shoulders, now[0]):
        # The target in the frame that the first joint turns.
        seen = Pose.of((0, 0, 0, 0, 0, math.degrees(first))).inverted().then(target)
        rest = _spherical(geometry, seen, now) if spherical else _parallel(geometry, seen, now)
        for thetas in rest:
            yield tuple(
                math.remainder(math.degrees(theta) - link.offset, 360)
                for theta, link in zip((first, *thetas), links)
            )


def _beside(geometry: Geometry, target: Pose) -> tuple[float, float]:
    """Return both angles of the first joint; ``d`` of the fourth link offsets the wrist."""
    reach, beside = geometry.links[5].d, geometry.links[3].d
    x, y = (p - reach * axis for p, axis in zip(target.origin[:2], target.z[:2]))
    aside = math.asin(_unit(beside / max(math.hypot(x, y), ROUNDING)))
    towards = math.atan2(y, x)
    return towards + aside, towards + math.pi - aside


def _in_line(geometry: Geometry, target: Pose) -> tuple[float, float]:
    """Return both angles of the first joint that turn the arm's plane through the wrist."""
    x, y = (p - geometry.links[5].d * axis for p, axis in zip(target.origin[:2], target.z[:2]))
    towards = math.atan2(y, x)
    return towards, towards + math.pi


def _parallel(geometry: Geometry, seen: Pose, now: Sequence[float]) -> Iterator[tuple[float, ...]]:
    """Yield the second to the sixth angle of an arm with the axes of the 280 or the 320."""
    links = geometry.links
    sign = 1 if links[3].alpha > 0 else -1
    across = tuple(-axis[1] for axis in seen[:3])
    for fifth, sixth in _wrists(across, sign * now[4], now[5]):
        turn, x, y = _fourth_frame(geometry, seen, fifth, sixth, sign * links[4].d)
        for second, third in _elbows(x, y, links[1].a, links[2].a, now[2]):
            yield second, third, turn - second - third, sign * fifth, sixth


def _spherical(geometry: Geometry, seen: Pose, now: Sequence[float]) -> Iterator[tuple[float, ...]]:
    """Yield the second to the sixth angle of an arm with the axes of the mechArm."""
    links = geometry.links
    x, _, z = (p - links[5].d * axis for p, axis in zip(seen.origin, seen.z))
    lower, bent = math.hypot(links[2].a, links[3].d), math.atan2(links[3].d, links[2].a)
    for second, elbow in _elbows(x, links[0].d - z, links[1].a, lower, now[2] + bent):
        third = elbow - bent
        cos, sin = math.cos(second + third), math.sin(second + third)
        # The third frame's z axis in the target's frame; its x axis is (cos, 0, -sin).
        across = tuple(-sin * axis[0] - cos * axis[2] for axis in seen[:3])
        for fifth, sixth in _wrists(across, now[4], now[5]):
            wx, wy, wz = seen.direction((math.sin(sixth), math.cos(sixth), 0.0))
            yield second, third, math.atan2(sin * wz - cos * wx, -wy), fifth, sixth


def _wrists(across: Sequence[float], fifth: float, sixth: float) -> Iterator[tuple[float, float]]:
    """Yield pairs of the fifth and the sixth angle.

    ``across`` has the components of the target's axes along the axis of the fourth joint. A
    straight wrist leaves the sixth angle free: its present value comes first, then others.
    """
    u, v, cosine = across
    for side in (1, -1) if math.sin(fifth) >= 0 else (-1, 1):
        sine = side * math.hypot(u, v)
        bend = math.atan2(sine, cosine)
        if abs(sine) > WRIST_STRAIGHT:
            yield bend, math.atan2(-v * side, u * side)
        if abs(sine) <= WRIST_NEARLY_STRAIGHT:
            for turn in range(0, 360, WRIST_STEP):
                yield bend, sixth + math.radians(turn)


def _elbows(
    x: float, y: float, upper: float, lower: float, elbow: float
) -> Iterator[tuple[float, float]]:
    """Yield the second angle and the bend of the elbow, to either side, in the arm's plane."""
    bend = math.acos(_unit((x * x + y * y - upper**2 - lower**2) / (2 * upper * lower)))
    for third in _nearest_first((bend, -bend), elbow):
        along, aside = upper + lower * math.cos(third), lower * math.sin(third)
        yield math.atan2(y, x) - math.atan2(aside, along), third


def _fourth_frame(
    geometry: Geometry, seen: Pose, fifth: float, sixth: float, beyond: float
) -> tuple[float, float, float]:
    """Return the angle and the position of the fourth frame in the arm's plane.

    The plane is that of the first frame's x and y: horizontally along the arm, and up. ``beyond``
    is how far the fifth link reaches along its joint.
    """
    cos5, sin5, cos6, sin6 = math.cos(fifth), math.sin(fifth), math.cos(sixth), math.sin(sixth)
    links = geometry.links
    # The fourth frame's x axis and z axis, in the target's frame.
    along: Vector = (cos5 * cos6, -cos5 * sin6, -sin5)
    normal: Vector = (-sin6, -cos6, 0.0)
    ax, _, az = seen.direction(along)
    nx, _, nz = seen.direction(normal)
    px, _, pz = (p - links[5].d * z for p, z in zip(seen.origin, seen.z))
    x = px - beyond * nx
    y = pz - beyond * nz - links[0].d
    return math.atan2(az, ax), x, y


def _nearest_first(angles: Iterable[float], present: float) -> list[float]:
    """Sort angles, in radians, by their distance from the present one."""
    return sorted(angles, key=lambda one: abs(math.remainder(one - present, math.tau)))


def _unit(value: float) -> float:
    """Clamp a sine or cosine to -1..1; rounding may have moved it slightly outside."""
    return min(max(value, -1.0), 1.0)
