"""The nearest angles inside the limits, by least squares. The only importer of SciPy.

SciPy comes with the extra ``sim``; it is imported when a target lies at the edge of the reach.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain

from scipy.optimize import least_squares

from cobotwire.simulator.kinematics.forward import flange, frames
from cobotwire.simulator.kinematics.geometry import Geometry
from cobotwire.simulator.kinematics.pose import Pose, Vector, cross

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

    def slopes(angles: Sequence[float]) -> list[list[float]]:
        return _slopes(geometry, angles)

    found = least_squares(off, guess, slopes, bounds=(lowest, highest))
    return tuple(min(max(float(angle), low), high) for angle, (low, high) in zip(found.x, limits))


def _slopes(geometry: Geometry, angles: Sequence[float]) -> list[list[float]]:
    """Return how the flange's origin and axes change with a degree of each joint, a row each.

    SciPy would try each joint by itself, which takes longer.
    """
    here = frames(geometry, angles)
    end = here[-1]
    columns = [[0.0] * 12 for _ in range(geometry.joints)]
    axis: Vector = (0.0, 0.0, 1.0)
    origin: Vector = (0.0, 0.0, 0.0)
    for turns, frame in zip(geometry.turns, here):
        if turns:
            (ex, ey, ez), (ox, oy, oz) = end.origin, origin
            lever = ex - ox, ey - oy, ez - oz
            moved = [cross(axis, part) for part in (lever, *end[:3])]
            for joint, share in turns:
                column = columns[joint]
                for row, part in enumerate(chain(*moved)):
                    weight = 1.0 if row < 3 else WEIGHT_OF_AXES
                    column[row] += part * weight * math.radians(share)
        axis, origin = frame.z, frame.origin
    return [list(row) for row in zip(*columns)]
