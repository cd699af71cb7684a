"""The nearest angles inside the limits, by least squares. The only importer of SciPy.

SciPy comes with the extra ``sim``; it is imported when a target lies at the edge of the reach.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from scipy.optimize import least_squares

from cobotwire.simulator.kinematics.forward import flange
from cobotwire.simulator.kinematics.geometry import Geometry
from cobotwire.simulator.kinematics.pose import Pose

# One millimetre weighs as much as a fifth of a degree, in the ratio of the two tolerances.
WEIGHT_OF_AXES = math.degrees(1) * 5
# Bounds must differ; a joint that may not move at all gets this range, in degrees.
SMALLEST_RANGE = 1e-9


def refined(
    geometry: Geometry,
    guess: Sequence[float],
    target: Pose,
    limits: Sequence[tuple[float, float]],
) -> tuple[float, ...]:
    """Return the angles inside ``limits``, near ``guess``, that come nearest to ``target``."""
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
