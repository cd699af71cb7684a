"""Draw joint angles inside the limits of the edition mycobot280, for tests and benchmarks."""

from __future__ import annotations

import random
from collections.abc import Iterable

from cobotwire.editions.mycobot280 import TABLE
from cobotwire.kinematics import Geometry, geometry_of, ticks
from cobotwire.protocol.robot import Encoders
from cobotwire.simulator.start import steps

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


def _encoders() -> Encoders:
    """Return how the encoders of the 280 count, which its edition states."""
    found = TABLE.robot.encoders
    assert found is not None
    return found


ENCODERS = _encoders()
STEPS = steps(TABLE)


def reported_angles(degrees: Iterable[float]) -> tuple[float, ...]:
    """Return angles as the 280 reports them."""
    return ticks.reported_angles(ENCODERS, degrees, STEPS)


def reported_coords(coords: Iterable[float]) -> tuple[float, ...]:
    """Return coordinates as the 280 reports them."""
    return ticks.reported_coords(coords, STEPS)


def random_angles(rng: random.Random) -> tuple[float, ...]:
    """Return angles of six joints, each anywhere inside its limits."""
    return tuple(rng.uniform(low, high) for low, high in LIMITS)


def within_limits(angles: tuple[float, ...]) -> bool:
    """Return whether each joint is inside its limits."""
    return all(low <= angle <= high for angle, (low, high) in zip(angles, LIMITS))
