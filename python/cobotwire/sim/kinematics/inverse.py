"""Inverse kinematics: every way in which the joints put the flange where it shall be.

The arms here have three parallel joints (the second to the fourth) and three whose axes cross those
at right angles, so that a pose has at most eight solutions in closed form: two shoulders, two
wrists, two elbows. Where a pose lies a hair beyond what is reachable - it was rounded to what the
wire can say, or the arm is stretched out - SciPy looks for the nearest angles that are.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice

from cobotwire.sim.kinematics.forward import flange
from cobotwire.sim.kinematics.geometry import Geometry
from cobotwire.sim.kinematics.pose import Pose, Vector

Angles = tuple[float, ...]
Limits = Sequence[tuple[float, float]]

# What a solution in closed form may be off by rounding.
EXACT_MILLIMETRES, EXACT_DEGREES = 1e-3, 1e-3
# On the edge of the reach a solution puts the flange within this of its target. Cutting each number
# to its step takes up to 0.173 mm and 0.017 degrees from a pose; least squares may put a share of
# the one on the other. So what get_coords tells can be sent.
MILLIMETRES, DEGREES = 0.22, 0.03
# What is closer than this may become a solution when its joints give way a little.
NEAR_MILLIMETRES, NEAR_DEGREES = 10.0, 3.0
# Below this sine of the fifth joint, the fourth and the sixth turn about the same axis; below the
# second they nearly do, and what the wire cuts off a pose may decide how far each turns.
WRIST_STRAIGHT, WRIST_NEARLY_STRAIGHT = 1e-7, 1e-2
# Then the sixth is tried in steps of so many degrees.
WRIST_TRIES = 30
# So many guesses are worked on before a target counts as out of reach.
GUESSES = 8
ROUNDING = 1e-6


def prepare() -> None:
    """Import SciPy where it is installed: it takes longer than some answers may.

    Else the first target on the edge of the reach waits for it.
    """
    with suppress(ImportError):
        importlib.import_module("cobotwire.sim.kinematics.refine")


def nearest(
    geometry: Geometry, target: Pose, present: Sequence[float], limits: Limits
) -> Angles | None:
    """The solution inside the limits that is nearest to the present angles; None: there is none.

    Args:
        geometry: the arm.
        target: the flange's pose, seen from the base.
        present: the angles to stay close to, in degrees. Near is what takes the least time: the
            joint with the longest way counts, then the sum of all ways.
        limits: the lowest and the highest angle of each joint, in degrees.

    Raises:
        ImportError: only SciPy could tell, and it is not installed.
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
        from cobotwire.sim.kinematics.refine import refined  # an extra, and slow to import

        better = refined(geometry, guess, target, limits)
        if not _misses(geometry, better, target, MILLIMETRES, DEGREES):
            return better
    return None


def solutions(geometry: Geometry, target: Pose, present: Sequence[float]) -> Iterator[Angles]:
    """Each solution in degrees, -180..180, limits left aside.

    Where the target is out of reach, these are the angles that come close to it, perhaps.
    ``present`` decides where a straight wrist leaves the sixth joint free.
    """
    for first in _shoulders(geometry, target):
        # The target's axes and origin along the first joint's own axes.
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
    """Both first angles that leave the wrist beside the arm's plane by the fourth offset."""
    reach = geometry.links[5].d
    x, y = (p - reach * axis for p, axis in zip(target.origin[:2], target.z[:2]))
    aside = math.asin(_unit(geometry.links[3].d / max(math.hypot(x, y), ROUNDING)))
    towards = math.atan2(y, x)
    yield towards + aside
    yield towards + math.pi - aside


def _wrists(
    geometry: Geometry, across: tuple[float, ...], side: int, present: Sequence[float]
) -> Iterator[tuple[float, float]]:
    """Fifth and sixth angle, from what the target's axes have across the arm's plane.

    A straight wrist leaves the sixth free: it stays, or turns by as much as the limits need.
    """
    u, v, cosine = across
    sine = side * math.hypot(u, v)
    fifth = math.atan2(sine, cosine)
    if abs(sine) > WRIST_STRAIGHT:
        yield fifth, math.atan2(-v * side, u * side)
    if abs(sine) > WRIST_NEARLY_STRAIGHT:
        return
    for turn in range(0, 360, WRIST_TRIES):
        yield fifth, math.radians(present[5] + geometry.links[5].offset + turn)


def _elbows(
    geometry: Geometry, seen: Pose, fifth: float, sixth: float
) -> Iterator[tuple[float, float, float]]:
    """The three angles in the arm's plane, with the elbow to either side."""
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
    """How far the fourth frame is turned in the arm's plane, and where it is there.

    The plane is the first frame's x and y: the base's horizontal along the arm, and up.
    """
    cos5, sin5, cos6, sin6 = math.cos(fifth), math.sin(fifth), math.cos(sixth), math.sin(sixth)
    links = geometry.links
    # The fourth frame's x axis and z axis, said in the target's own axes.
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
    """The same angles inside the limits, by whole turns nearest to the present ones."""
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
    """What of it lies inside the limits, the nearest first; each once."""
    inside = (_within(one, present, limits, slack) for one in found)

    def way(angles: Angles) -> tuple[float, float]:
        ways = [abs(a - b) for a, b in zip(angles, present)]
        return max(ways), sum(ways)

    return sorted(dict.fromkeys(one for one in inside if one is not None), key=way)


def _unit(value: float) -> float:
    """A sine or cosine; what is a hair outside is the nearest."""
    return min(max(value, -1.0), 1.0)
