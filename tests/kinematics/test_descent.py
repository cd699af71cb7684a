"""Least squares find the angles of a pose from a guess near them, also for coupled joints."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

import pytest
from scipy.optimize import least_squares

from cobotwire.editions import load, names
from cobotwire.kinematics import Effort, Geometry, Pose, flange, geometry_of
from cobotwire.kinematics.descent import descend
from cobotwire.kinematics.inverse import REFINING_RADIAN
from cobotwire.kinematics.nearness import DEGREES as NEAR_DEGREES
from cobotwire.kinematics.nearness import MILLIMETRES as NEAR_MILLIMETRES
from cobotwire.kinematics.nearness import misses
from kinematic_samples import LIMITS, MYCOBOT_280

GEOMETRIES = {
    name: found for name in names() if (found := geometry_of(load(name).TABLE)) is not None
}


@pytest.mark.parametrize("name", GEOMETRIES)
def test_pose_is_found_from_angles_near_it(name: str) -> None:
    geometry, chance = GEOMETRIES[name], random.Random(2)
    limits = [(-150.0, 150.0)] * geometry.joints
    for _ in range(5):
        angles = [chance.uniform(-140, 140) for _ in range(geometry.joints)]
        guess = [angle + chance.uniform(-3, 3) for angle in angles]
        target = flange(geometry, angles)
        found = descend(geometry, target, guess, limits, REFINING_RADIAN, Effort())
        millimetres, degrees = flange(geometry, found).distance(target)
        assert millimetres < 0.01
        assert degrees < 0.01


def _by_scipy(geometry: Geometry, target: Pose, guess: Sequence[float]) -> tuple[float, ...]:
    """Return the angles that scipy's bounded least squares finds, without analytic derivatives."""
    weight = REFINING_RADIAN / math.sqrt(2)

    def off(angles: Sequence[float]) -> list[float]:
        pose = flange(geometry, angles)
        turns = ((a - b) * weight for p, q in zip(pose[:3], target[:3]) for a, b in zip(p, q))
        return [*(a - b for a, b in zip(pose.origin, target.origin)), *turns]

    found = least_squares(off, guess, bounds=tuple(zip(*LIMITS)))
    return tuple(map(float, found.x))


def test_angles_at_the_edge_of_the_reach_are_as_near_as_those_of_scipy() -> None:
    chance, reached = random.Random(3), []
    for _ in range(40):
        # Joints 2 to 4 are nearly stretched out; the target is up to 0.5 mm from the flange.
        spread = (100.0, 2.0, 2.0, 2.0, 100.0, 100.0)
        guess = [chance.uniform(-one, one) for one in spread]
        pose = flange(MYCOBOT_280, guess)
        x, y, z = (part + chance.uniform(-0.3, 0.3) for part in pose.origin)
        target = pose._replace(origin=(x, y, z))
        found = descend(MYCOBOT_280, target, guess, LIMITS, REFINING_RADIAN, Effort())
        other = _by_scipy(MYCOBOT_280, target, guess)
        (way, _), (way_there, _) = (
            flange(MYCOBOT_280, one).distance(target) for one in (found, other)
        )
        assert way == pytest.approx(way_there, abs=0.01)
        reached.append(not misses(MYCOBOT_280, found, target, NEAR_MILLIMETRES, NEAR_DEGREES))
        there = not misses(MYCOBOT_280, other, target, NEAR_MILLIMETRES, NEAR_DEGREES)
        assert reached[-1] == there
    assert {True, False} == set(reached)
