"""Joint angles inside the limits of the edition mycobot280, for tests and measurements."""

from __future__ import annotations

import random

from cobotwire.editions.mycobot280 import TABLE

LIMITS = [
    (number.minimum / number.divide, number.maximum / number.divide)
    for number in TABLE.in_role("joint targets").request[0].fields[0].cases[0].numbers
]


def random_angles(rng: random.Random) -> tuple[float, ...]:
    """Angles of six joints, each anywhere inside its limits."""
    return tuple(rng.uniform(low, high) for low, high in LIMITS)


def within_limits(angles: tuple[float, ...]) -> bool:
    """Whether each joint is inside its limits."""
    return all(low <= angle <= high for angle, (low, high) in zip(angles, LIMITS))
