"""The nearest angles inside the limits, by least squares: the only importer of SciPy.

It comes with the extra ``sim``. It is imported when a target lies on the edge of what is reachable.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from scipy.optimize import least_squares

from cobotwire.sim.kinematics.forward import flange
from cobotwire.sim.kinematics.geometry import Geometry
from cobotwire.sim.kinematics.pose import Pose

# One millimetre weighs as much as a fifth of a degree: the ratio of what a solution may miss by.
WEIGHT_OF_AXES = math.degrees(1) * 5
# Bounds must be apart; a joint that may not move at all gets this much, in degrees.
SMALLEST_RANGE = 1e-9


def refined(
    geometry: Geometry,
    guess: Sequence[float],
    target: Pose,
    limits: Sequence[tuple[float, float]],
) -> tuple[float, ...]:
    """The angles near ``guess``, inside ``limits``, whose flange is nearest to ``target``."""
    lowest = [low for low, _ in limits]
    highest = [max(high, low + SMALLEST_RANGE) for low, high in limits]

    def off(angles: Sequence[float]) -> list[float]:
        pose = flange(geometry, angles)
        turns = (
            (a - b) * WEIGHT_OF_AXES for p, q in zip(pose[:3], target[:3]) for a, b in zip(p, q)
        )
        return [*(a - b for a, b in zip(pose.origin, target.origin)), *turns]

    found = least_squares(off, guess, bounds=(lowest, highest))
    return tuple(min(max(float(angle), low), high) for angle, (low, high) in zip(found.x, limits))
