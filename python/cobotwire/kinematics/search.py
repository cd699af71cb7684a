"""Inverse kinematics of any arm, by damped least squares from several starts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from cobotwire.kinematics.descent import Effort, clamped, descend
from cobotwire.kinematics.geometry import Angles, Geometry
from cobotwire.kinematics.nearness import (
    DEGREES,
    EXACT_DEGREES,
    EXACT_MILLIMETRES,
    MILLIMETRES,
    Limits,
    misses,
    turns_between,
)
from cobotwire.kinematics.pose import Pose

# A turn by one degree weighs as much as 5 mm.
SEARCH_RADIAN = math.degrees(1) * 5
# How many starts are tried, and how many solutions are compared.
STARTS, SOLUTIONS = 48, 3
# The roots of these primes have fractional parts that spread starts evenly.
PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29)


def search(
    geometry: Geometry,
    target: Pose,
    present: Sequence[float],
    limits: Limits,
    largest_turn: float,
    effort: Effort,
) -> Angles | None:
    """Return angles inside the limits that bring the flange to ``target``; None: none were found.

    The search ends when ``effort`` is used up. It starts only at angles within ``largest_turn``
    degrees of the present ones, since joints cannot jump inside a motion. A solution may be further
    away.

    Of several solutions, the nearest to ``present`` is returned. If none is exact, angles that miss
    the target by less than the wire's rounding count as a solution.
    """
    if any(low > high for low, high in limits):
        return None
    exact: list[Angles] = []
    rough: list[Angles] = []
    for index, start in enumerate(_starts(present, limits)):
        if index and _turn(start, present) > largest_turn:
            continue
        if not effort.left:
            break
        found = descend(geometry, target, start, limits, SEARCH_RADIAN, effort)
        if not misses(geometry, found, target, EXACT_MILLIMETRES, EXACT_DEGREES):
            exact.append(found)
            # The joints' own start usually leads to the nearest solution.
            if index == 0 or len(exact) == SOLUTIONS:
                break
        elif not misses(geometry, found, target, MILLIMETRES, DEGREES):
            rough.append(found)
    return min(exact or rough, key=lambda one: turns_between(one, present), default=None)


def _turn(start: Sequence[float], present: Sequence[float]) -> float:
    """Return the largest turn of a joint."""
    return max((abs(one - other) for one, other in zip(start, present)), default=0.0)


def _starts(present: Sequence[float], limits: Limits) -> Iterator[list[float]]:
    """Yield the present angles, then angles that are spread evenly inside the limits."""
    yield clamped(present, limits)
    for index in range(1, STARTS):
        spread = (
            math.sqrt(PRIMES[joint % len(PRIMES)]) * index % 1 for joint in range(len(limits))
        )
        yield [low + (high - low) * share for share, (low, high) in zip(spread, limits)]
