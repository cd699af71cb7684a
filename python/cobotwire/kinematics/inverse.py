"""Inverse kinematics: the joint angles that bring the flange to a pose, for any geometry.

Arms with the axes of the 280, the 320 or the mechArm have a solution in closed form. Rounding on
the wire can put a pose slightly out of reach, above all if the arm is stretched out. Then least
squares find the nearest angles. For other arms, ``search`` finds the angles step by step.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import islice

from cobotwire.kinematics.closed_form import ROUNDING, is_solved, solutions
from cobotwire.kinematics.descent import Effort, descend
from cobotwire.kinematics.geometry import Angles, Geometry
from cobotwire.kinematics.nearness import (
    DEGREES,
    EXACT_DEGREES,
    EXACT_MILLIMETRES,
    MILLIMETRES,
    Limits,
    misses,
    nearest_first,
    turns_between,
    within,
)
from cobotwire.kinematics.pose import Pose
from cobotwire.kinematics.search import search

# Angles that miss the target by less than this may be refined into a solution.
NEAR_MILLIMETRES, NEAR_DEGREES = 10.0, 3.0
# How many guesses are refined before a target counts as out of reach.
GUESSES = 8
# How many solutions in closed form take as long as a step of a descent. A straight wrist has 96.
SOLUTIONS_A_STEP = 2
# How many solutions may continue a path, before all are compared.
CONTINUING = 4
# A turn is weighted by the distance that it moves the ends of the three axes: 7.07 mm for a degree.
# This is nearly the ratio of the two tolerances, so least squares treat both alike.
REFINING_RADIAN = math.degrees(1) * 5 * math.sqrt(2)


def nearest(
    geometry: Geometry,
    target: Pose,
    present: Sequence[float],
    limits: Limits,
    largest_turn: float = math.inf,
    effort: Effort | None = None,
) -> Angles | None:
    """Return the solution inside the limits that is nearest to the present angles, or None.

    Args:
        geometry: the arm.
        target: the flange's pose in the frame of the base.
        present: the angles to stay close to, in degrees. Solutions are compared by
            the joint that turns farthest, because that decides how long a motion takes, then by the
            sum of all turns. Without a closed form, only solutions that the search finds count.
        limits: the lowest and the highest angle of each joint, in degrees.
        largest_turn: for a point of a path, how far a joint should turn at most, in degrees. The
            first solution within it is taken; if there is none, joints may turn further.
        effort: bounds the search; None: the effort for one request. What the search does not find
            counts as out of reach.
    """
    effort = Effort() if effort is None else effort
    if not is_solved(geometry):
        return search(geometry, target, present, limits, largest_turn, effort)
    if largest_turn < math.inf:
        # The next point of a path: nearly always the first solution continues it.
        for one in islice(solutions(geometry, target, present), CONTINUING):
            near = within(one, present, limits, ROUNDING)
            if (
                near is not None
                and turns_between(near, present)[0] <= largest_turn
                and not misses(geometry, near, target, EXACT_MILLIMETRES, EXACT_DEGREES)
            ):
                return near
    if not effort.left:
        return None
    found = list(solutions(geometry, target, present))
    effort.spend(len(found) // SOLUTIONS_A_STEP)
    for one in nearest_first(found, present, limits, ROUNDING):
        if not misses(geometry, one, target, EXACT_MILLIMETRES, EXACT_DEGREES):
            return one
    almost = (
        one
        for one in nearest_first(found, present, limits, NEAR_DEGREES)
        if not misses(geometry, one, target, NEAR_MILLIMETRES, NEAR_DEGREES)
    )
    for guess in islice(almost, GUESSES):
        better = descend(geometry, target, guess, limits, REFINING_RADIAN, effort)
        if not misses(geometry, better, target, MILLIMETRES, DEGREES):
            return better
    return None
