"""Draw joint angles inside the limits of the edition mycobot280, for tests and benchmarks."""

from __future__ import annotations

import random

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator.kinematics import Geometry, geometry_of

LIMITS = [
    (number.physical(number.minimum), number.physical(number.maximum))
    for number in TABLE.in_role("joint targets").request[0].fields[0].cases[0].numbers
]


def _geometry() -> Geometry:
    """Return the geometry of the 280, which its edition states."""
    found = geometry_of(TABLE)
    assert found is not None
    return found


MYCOBOT_280 = _geometry()


def random_angles(rng: random.Random) -> tuple[float, ...]:
    """Return angles of six joints, each anywhere inside its limits."""
    return tuple(rng.uniform(low, high) for low, high in LIMITS)


def within_limits(angles: tuple[float, ...]) -> bool:
    """Return whether each joint is inside its limits."""
    return all(low <= angle <= high for angle, (low, high) in zip(angles, LIMITS))
