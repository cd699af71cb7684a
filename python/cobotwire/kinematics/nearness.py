"""How near joint angles are to a target, to the limits, and to where the joints are."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.kinematics.forward import flange
from cobotwire.kinematics.geometry import Angles, Geometry
from cobotwire.kinematics.pose import Pose

Limits = Sequence[tuple[float, float]]

# How far rounding may move an exact solution.
EXACT_MILLIMETRES, EXACT_DEGREES = 1e-3, 1e-3
# At the edge of the reach, a solution may miss its target by this much. Truncating each number to
# its step moves a pose by up to 0.173 mm and 0.017 degrees; least squares may trade one for the
# other. So coordinates that get_coords reported can be sent.
MILLIMETRES, DEGREES = 0.22, 0.03


def misses(
    geometry: Geometry, angles: Angles, target: Pose, millimetres: float, degrees: float
) -> bool:
    """Return whether angles bring the flange further from a target than the tolerances."""
    distance, turn = flange(geometry, angles).distance(target)
    return distance > millimetres or turn > degrees


def turns_between(angles: Sequence[float], present: Sequence[float]) -> tuple[float, float]:
    """Return the largest turn of a joint, then the sum of all turns: the smaller, the nearer."""
    turns = [abs(a - b) for a, b in zip(angles, present)]
    return max(turns), sum(turns)


def nearest_first(
    found: Sequence[Angles], present: Sequence[float], limits: Limits, slack: float
) -> list[Angles]:
    """Return the different angles that lie inside the limits, the nearest first."""
    inside = (within(one, present, limits, slack) for one in found)
    kept = dict.fromkeys(one for one in inside if one is not None)
    return sorted(kept, key=lambda angles: turns_between(angles, present))


def within(angles: Angles, present: Sequence[float], limits: Limits, slack: float) -> Angles | None:
    """Return the angles inside the limits, moved by full turns towards the present angles."""
    kept = []
    for angle, now, (lowest, highest) in zip(angles, present, limits):
        turns = (angle - 360, angle, angle + 360)
        fit = [one for one in turns if lowest - slack <= one <= highest + slack]
        if not fit or lowest > highest:
            return None
        kept.append(min(max(min(fit, key=lambda one: abs(one - now)), lowest), highest))
    return tuple(kept)
