"""Inverse kinematics: the joint angles that bring the flange to a pose, for any geometry.

Arms with the axes of the 280 have a solution in closed form. A pose may lie slightly out of their
reach, because the wire rounds it or the arm is stretched out; then SciPy searches for the nearest
angles. For other arms, ``search`` finds the angles step by step, without SciPy.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from contextlib import suppress
from itertools import islice

from cobotwire.simulator.kinematics.closed_form import ROUNDING, is_solved, solutions
from cobotwire.simulator.kinematics.geometry import Angles, Geometry
from cobotwire.simulator.kinematics.nearness import (
    DEGREES,
    EXACT_DEGREES,
    EXACT_MILLIMETRES,
    MILLIMETRES,
    Limits,
    by_way,
    misses,
)
from cobotwire.simulator.kinematics.pose import Pose
from cobotwire.simulator.kinematics.search import search

# Angles that miss the target by less than this may be refined into a solution.
NEAR_MILLIMETRES, NEAR_DEGREES = 10.0, 3.0
# How many guesses are refined before a target counts as out of reach.
GUESSES = 8


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
            time: the joint with the longest way counts, then the sum of all ways. Without a closed
            form, it is the nearest of those that the search finds.
        limits: the lowest and the highest angle of each joint, in degrees.

    Raises:
        ImportError: SciPy is needed, and not installed.
    """
    if not is_solved(geometry):
        return search(geometry, target, present, limits)
    found = list(solutions(geometry, target, present))
    for one in by_way(found, present, limits, ROUNDING):
        if not misses(geometry, one, target, EXACT_MILLIMETRES, EXACT_DEGREES):
            return one
    almost = (
        one
        for one in by_way(found, present, limits, NEAR_DEGREES)
        if not misses(geometry, one, target, NEAR_MILLIMETRES, NEAR_DEGREES)
    )
    for guess in islice(almost, GUESSES):
        from cobotwire.simulator.kinematics.refine import refined  # an extra, and slow to import

        better = refined(geometry, guess, target, limits)
        if not misses(geometry, better, target, MILLIMETRES, DEGREES):
            return better
    return None
