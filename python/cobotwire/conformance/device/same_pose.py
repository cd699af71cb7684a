"""Tell whether two sets of joint angles are the same pose, within the rounding of the protocol."""

from __future__ import annotations

import math
from collections.abc import Sequence

from cobotwire.kinematics import Effort, Geometry, flange, geometry_of
from cobotwire.kinematics.descent import descend
from cobotwire.kinematics.inverse import REFINING_RADIAN
from cobotwire.kinematics.nearness import misses
from cobotwire.protocol.table import Table
from cobotwire.simulator.start import steps

# The number of sections of the path between two sets of angles, and the most steps that bring the
# end of a section back to the pose.
SECTIONS, STEPS = 32, 8
# A section may be DETOUR times as long as the average, and FREE_SECTION degrees in any case.
DETOUR, FREE_SECTION = 4.0, 1.0
NO_LIMIT = (-math.inf, math.inf)


def is_same_pose(table: Table, one: Sequence[float], other: Sequence[float]) -> bool:
    """Return whether two sets of angles may be the same pose.

    With a straight elbow or wrist, joints turn far while the coordinates hardly change, and the
    rounding of the protocol hides where they are. So angles are the same if the joints can turn
    from one set to the other while the end stays where it is, within the rounding. Another solution
    for the pose, with the elbow on the other side, is not the same: on the way the end would move.

    Without the geometry of the arm, the result is False.
    """
    geometry = geometry_of(table)
    if geometry is None or len(one) != geometry.joints:
        return False
    here, near = flange(geometry, other), _rounding(table, geometry, other)
    at, longest = tuple(other), max(FREE_SECTION, DETOUR * math.dist(one, other) / SECTIONS)
    for left in range(SECTIONS, 0, -1):
        there = tuple(angle + (goal - angle) / left for goal, angle in zip(one, at))
        if left > 1 and misses(geometry, there, here, *near):
            limits = [NO_LIMIT] * len(at)
            there = descend(geometry, here, there, limits, REFINING_RADIAN, Effort(STEPS))
        if misses(geometry, there, here, *near) or math.dist(there, at) > longest:
            return False
        at = there
    return True


def _rounding(table: Table, geometry: Geometry, angles: Sequence[float]) -> tuple[float, float]:
    """Return how far rounding may move and turn the end, in millimetres and degrees.

    Coordinates are rounded when they are reported, and again in calculations. So are the angles of
    the joints; each moves the end in proportion to its distance from the joint.
    """
    rounded = steps(table)
    widths = [2 / step if step else 0.0 for step in rounded.coords]
    way, turn = math.hypot(*widths[:3]), math.hypot(*widths[3:])
    width, here = (2 / rounded.angle if rounded.angle else 0.0), flange(geometry, angles)
    for joint in range(geometry.joints):
        moved = [angle + width * (at == joint) for at, angle in enumerate(angles)]
        far, turned = flange(geometry, moved).distance(here)
        way, turn = way + far, turn + turned
    return way, turn
