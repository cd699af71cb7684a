"""Inverse kinematics: all joint angles that bring the flange to a pose.

The arms here have three parallel joints (the second to the fourth); the axes of the others cross
those at right angles. So a pose has at most eight solutions in closed form: two shoulders, two
wrists, two elbows. A pose may lie slightly out of reach, because the wire rounds it or the arm is
stretched out; then SciPy searches for the nearest angles.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice

from cobotwire.simulator.kinematics.forward import flange
from cobotwire.simulator.kinematics.geometry import Geometry
from cobotwire.simulator.kinematics.pose import Pose, Vector

Angles = tuple[float, ...]
Limits = Sequence[tuple[float, float]]

# How far rounding may move a solution in closed form.
EXACT_MILLIMETRES, EXACT_DEGREES = 1e-3, 1e-3
# At the edge of the reach, a solution may miss its target by this much. Truncating each number to
# its step moves a pose by up to 0.173 mm and 0.017 degrees; least squares may trade one for the
# other. So coordinates that get_coords reported can be sent.
MILLIMETRES, DEGREES = 0.22, 0.03
# Angles that miss the target by less than this may be refined into a solution.
NEAR_MILLIMETRES, NEAR_DEGREES = 10.0, 3.0
# Below this sine of the fifth joint, the fourth and the sixth turn about the same axis. Below the
# second sine they nearly do, and the truncation of a pose may decide how far each of them turns.
WRIST_STRAIGHT, WRIST_NEARLY_STRAIGHT = 1e-7, 1e-2
# In that case, the search tries the sixth joint at steps of this many degrees.
WRIST_STEP = 30
# How many guesses are refined before a target counts as out of reach.
GUESSES = 8
ROUNDING = 1e-6


def prepare() -> None:
    """Import SciPy in advance, if it is installed.

    The import takes longer than the deadline of some replies. Without this call, the first target
    at the edge of the reach waits for it.
    """
    with suppress(ImportError):
        importlib.import_module("cobotwire.simulator.kinematics.refine")


def nearest(
    geometry: Geometry, target: Pose, present: Sequence[float], limits: Limits
) -> Angles | None:
    """Return the solution inside the limits that is nearest to the present angles, or None.

    Args:
        geometry: the arm.
        target: the flange's pose in the frame of the base.
        present: the angles to stay close to, in degrees. The nearest solution takes the least
            time: the joint with the longest way counts, then the sum of all ways.
        limits: the lowest and the highest angle of each joint, in degrees.

    Raises:
        ImportError: SciPy is needed, and not installed.
    """
    found = list(solutions(geometry, target, present))
    for one in _by_way(found, present, limits, ROUNDING):
        if not _misses(geometry, one, target, EXACT_MILLIMETRES, EXACT_DEGREES):
            return one
    almost = (
        one
        for one in _by_way(found, present, limits, NEAR_DEGREES)
        if not _misses(geometry, one, target, NEAR_MILLIMETRES, NEAR_DEGREES)
    )
    for guess in islice(almost, GUESSES):
        from cobotwire.simulator.kinematics.refine import refined  # an extra, and slow to import

        better = refined(geometry, guess, target, limits)
        if not _misses(geometry, better, target, MILLIMETRES, DEGREES):
            return better
    return None


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


def _within(
    angles: Angles, present: Sequence[float], limits: Limits, slack: float
) -> Angles | None:
    """Return the angles inside the limits, moved by full turns towards the present angles."""
    kept = []
    for angle, now, (lowest, highest) in zip(angles, present, limits):
        turns = (angle - 360, angle, angle + 360)
        fit = [one for one in turns if lowest - slack <= one <= highest + slack]
        if not fit or lowest > highest:
            return None
        kept.append(min(max(min(fit, key=lambda one: abs(one - now)), lowest), highest))
    return tuple(kept)


def _misses(
    geometry: Geometry, angles: Angles, target: Pose, millimetres: float, degrees: float
) -> bool:
    way, turn = flange(geometry, angles).distance(target)
    return way > millimetres or turn > degrees


def _by_way(
    found: Sequence[Angles], present: Sequence[float], limits: Limits, slack: float
) -> list[Angles]:
    """Return the different angles that lie inside the limits, the nearest first."""
    inside = (_within(one, present, limits, slack) for one in found)

    def way(angles: Angles) -> tuple[float, float]:
        ways = [abs(a - b) for a, b in zip(angles, present)]
        return max(ways), sum(ways)

    return sorted(dict.fromkeys(one for one in inside if one is not None), key=way)


def _unit(value: float) -> float:
    """Return a sine or cosine; rounding may have moved it slightly outside."""
    return min(max(value, -1.0), 1.0)
