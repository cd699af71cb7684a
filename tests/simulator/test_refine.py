"""Least squares find angles for a pose from angles near them, also for arms with coupled joints."""

from __future__ import annotations

import random

import pytest

from cobotwire.editions import load, names
from cobotwire.simulator.kinematics import flange, geometry_of
from cobotwire.simulator.kinematics.refine import WEIGHT_OF_AXES, _slopes, refined

DEGREES = 1e-5
GEOMETRIES = {
    name: found for name in names() if (found := geometry_of(load(name).TABLE)) is not None
}


@pytest.mark.parametrize("name", GEOMETRIES)
def test_slopes_are_those_of_the_forward_kinematics(name: str) -> None:
    geometry, chance = GEOMETRIES[name], random.Random(1)
    for _ in range(5):
        angles = [chance.uniform(-150, 150) for _ in range(geometry.joints)]
        slopes = _slopes(geometry, angles)
        for joint in range(geometry.joints):
            ends = []
            for way in (-DEGREES, DEGREES):
                turned = [angle + way * (at == joint) for at, angle in enumerate(angles)]
                ends.append(flange(geometry, turned))
            before, after = ([*end.origin, *end.x, *end.y, *end.z] for end in ends)
            for row, (one, other) in enumerate(zip(before, after)):
                weight = 1.0 if row < 3 else WEIGHT_OF_AXES
                slope = (other - one) * weight / (2 * DEGREES)
                assert slopes[row][joint] == pytest.approx(slope, abs=1e-3)


@pytest.mark.parametrize("name", GEOMETRIES)
def test_pose_is_found_from_angles_near_it(name: str) -> None:
    geometry, chance = GEOMETRIES[name], random.Random(2)
    for _ in range(5):
        angles = [chance.uniform(-140, 140) for _ in range(geometry.joints)]
        guess = [angle + chance.uniform(-3, 3) for angle in angles]
        target = flange(geometry, angles)
        found = refined(geometry, guess, target, [(-150.0, 150.0)] * geometry.joints)
        millimetres, degrees = flange(geometry, found).distance(target)
        assert millimetres < 0.01
        assert degrees < 0.01
