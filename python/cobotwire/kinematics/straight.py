"""A straight line in space: position and orientation change evenly."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from cobotwire.kinematics.descent import Effort
from cobotwire.kinematics.geometry import Angles, Geometry
from cobotwire.kinematics.inverse import nearest
from cobotwire.kinematics.nearness import Limits
from cobotwire.kinematics.pose import Pose, Vector

# A straight line is solved at points that are at most this far apart.
STEP_MILLIMETRES, STEP_DEGREES = 7.0, 3.0
# A joint that would turn more than this between two such points cannot follow, in degrees. The
# elbow of a straight arm of the 280 turns by 30 degrees in the first step towards the base.
LARGEST_TURN = 35.0

Quaternion = tuple[float, float, float, float]
# Below this sine of half the turn, there is no axis to turn about.
UNTURNED = 1e-9


def steps_between(start: Pose, end: Pose) -> int:
    """Return in how many steps a straight line is solved."""
    distance, turn = start.distance(end)
    return max(math.ceil(distance / STEP_MILLIMETRES), math.ceil(turn / STEP_DEGREES), 1)


def angles_along(
    geometry: Geometry,
    flanges: Iterable[Pose],
    start: Angles,
    limits: Limits,
    effort: Effort | None = None,
) -> list[Angles]:
    """Return the angles for poses of the flange that are close to each other.

    The list ends before the first pose to which the joints cannot follow. ``effort`` bounds the
    search for all poses together; None: the search for each pose has its own bound.
    """
    points: list[Angles] = []
    for flange in flanges:
        before = points[-1] if points else start
        found = nearest(geometry, flange, before, limits, LARGEST_TURN, effort)
        if found is None or max(abs(a - b) for a, b in zip(found, before)) > LARGEST_TURN:
            break
        points.append(found)
    return points


def straight_line(start: Pose, end: Pose, steps: int) -> Iterator[Pose]:
    """Yield the poses after ``start``, up to ``end``, in even steps.

    The orientation turns about one axis, by the smallest angle.
    """
    turn = start.inverted().then(end)
    half, axis = _half_turn(turn)
    for step in range(1, steps):
        share = step / steps
        here = start.then(_turned(axis, 2 * half * share))
        x, y, z = (a + (b - a) * share for a, b in zip(start.origin, end.origin))
        yield here._replace(origin=(x, y, z))
    yield end


def _half_turn(turn: Pose) -> tuple[float, Vector]:
    """Return half the angle of a turn in radians, and its axis."""
    w, x, y, z = quaternion(turn)
    sine = math.hypot(x, y, z)
    if sine < UNTURNED:
        return 0.0, (0.0, 0.0, 1.0)
    return math.atan2(sine, w), (x / sine, y / sine, z / sine)


def quaternion(turn: Pose) -> Quaternion:
    """Return the unit quaternion of a turn; its real part is not negative."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz), _ = turn
    squares = (1 + xx + yy + zz, 1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz)
    # Start from the largest part: the divisor must not be small.
    rows: tuple[Quaternion, ...] = (
        (squares[0], yz - zy, zx - xz, xy - yx),
        (yz - zy, squares[1], xy + yx, zx + xz),
        (zx - xz, xy + yx, squares[2], yz + zy),
        (xy - yx, zx + xz, yz + zy, squares[3]),
    )
    w, x, y, z = rows[squares.index(max(squares))]
    scale = math.copysign(1 / math.hypot(w, x, y, z), w)
    return w * scale, x * scale, y * scale, z * scale


def _turned(axis: Vector, angle: float) -> Pose:
    """Return a turn about an axis by an angle in radians."""
    cos, sin = math.cos(angle), math.sin(angle)
    x, y, z = axis
    rest = 1 - cos
    return Pose(
        (cos + x * x * rest, z * sin + y * x * rest, -y * sin + z * x * rest),
        (-z * sin + x * y * rest, cos + y * y * rest, x * sin + z * y * rest),
        (y * sin + x * z * rest, -x * sin + y * z * rest, cos + z * z * rest),
        (0.0, 0.0, 0.0),
    )
