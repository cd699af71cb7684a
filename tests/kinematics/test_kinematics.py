"""Test forward kinematics against recordings of an arm, and inverse against forward kinematics."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.kinematics import Pose, coords_of, flange, nearest
from cobotwire.kinematics.straight import straight_line
from kinematic_samples import (
    ENCODERS,
    LIMITS,
    MYCOBOT_280,
    random_angles,
    reported_angles,
    reported_coords,
    within_limits,
)

# Two pairs read from a real arm with firmware 6.5 (the protocol notes on kinematics).
RECORDED = [
    (
        (88.06, -138.33, 150.38, -151.96, 104.15, -13.71),
        (21.1, 108.9, 94.2, 75.19, 51.98, -114.61),
    ),
    ((95.18, -0.61, -0.61, -0.61, 88.85, -1.31), (15.3, 7.9, 410.7, -90.03, 0.52, 94.04)),
]
angles_on_wire = st.tuples(*(st.integers(-18000, 18000).map(lambda n: n / 100) for _ in range(6)))


@pytest.mark.parametrize(("angles", "coords"), RECORDED)
def test_recorded_pairs_of_a_real_arm_are_reproduced_bit_for_bit(
    angles: tuple[float, ...], coords: tuple[float, ...]
) -> None:
    standing = tuple(map(ENCODERS.on_tick, angles))
    assert reported_angles(standing) == angles
    assert reported_coords(coords_of(MYCOBOT_280, standing)) == coords


def _by_matrices(angles: tuple[float, ...]) -> list[list[float]]:
    """Multiply the matrices as in a textbook."""
    product = [[float(i == j) for j in range(4)] for i in range(4)]
    for angle, link in zip(angles, MYCOBOT_280.links):
        t, al = math.radians(angle + link.offset), math.radians(link.alpha)
        c, s, ca, sa = math.cos(t), math.sin(t), math.cos(al), math.sin(al)
        one: list[list[float]] = [
            [c, -s * ca, s * sa, link.a * c],
            [s, c * ca, -c * sa, link.a * s],
            [0, sa, ca, link.d],
            [0, 0, 0, 1],
        ]
        product = [
            [sum(product[i][k] * one[k][j] for k in range(4)) for j in range(4)] for i in range(4)
        ]
    return product


@given(angles_on_wire)
def test_unrolled_product_equals_the_textbook_formula(angles: tuple[float, ...]) -> None:
    pose, matrix = flange(MYCOBOT_280, angles), _by_matrices(angles)
    for column, part in enumerate(pose):
        assert part == pytest.approx([matrix[row][column] for row in range(3)], abs=1e-10)


@given(angles_on_wire, st.integers(-2048, 2048))
def test_tick_is_read_back_unchanged(angles: tuple[float, ...], tick: int) -> None:
    angle, on_tick = tick * ENCODERS.degrees, ENCODERS.on_tick
    assert on_tick(angle) == on_tick(reported_angles((angle,))[0]) == angle
    assert all(abs(on_tick(one) - one) <= ENCODERS.degrees / 2 for one in angles)
    assert ENCODERS.angle(2, ENCODERS.reading(2, angle)) == angle
    low, high = ENCODERS.inside(0, *sorted(angles[:2]))
    assert min(angles[:2]) <= low or low > high
    assert high <= max(angles[:2]) or low > high


@given(angles_on_wire, st.lists(st.floats(-300, 300), min_size=3, max_size=3))
def test_pose_equals_pose_of_its_coordinates_and_inverse_undoes_it(
    rotation: tuple[float, ...], origin: list[float]
) -> None:
    pose = Pose.of((*origin, *rotation[:3]))
    assert Pose.of(pose.coords).distance(pose) == pytest.approx((0, 0), abs=1e-6)
    nothing = Pose.of((0.0,) * 6)
    assert pose.then(pose.inverted()).distance(nothing) == pytest.approx((0, 0), abs=1e-6)


@given(st.randoms(use_true_random=False), st.integers(1, 40))
def test_straight_line_is_straight_and_even(rng: random.Random, steps: int) -> None:
    start, end = (flange(MYCOBOT_280, random_angles(rng)) for _ in range(2))
    poses = [start, *straight_line(start, end, steps)]
    way, turn = start.distance(end)
    assert poses[-1] == end
    for one, two in pairwise(poses):
        assert one.distance(two) == pytest.approx((way / steps, turn / steps), abs=1e-4)


@pytest.mark.parametrize(
    "cut", [tuple, reported_coords], ids=["as it is", "cut to the wire's steps"]
)
def test_forward_kinematics_undo_inverse_kinematics(
    cut: Callable[[Any], tuple[float, ...]],
) -> None:
    rng = random.Random(6)
    for _ in range(250):
        target = Pose.of(cut(coords_of(MYCOBOT_280, random_angles(rng))))
        found = nearest(MYCOBOT_280, target, random_angles(rng), LIMITS)
        assert found is not None, "each is the pose of some angles inside the limits"
        assert within_limits(found)
        way, turn = flange(MYCOBOT_280, found).distance(target)
        # Coordinates truncated by get_coords may be unreachable; then the nearest angles are used.
        assert way <= (0.1 if cut is tuple else 0.22)
        assert turn <= (0.02 if cut is tuple else 0.03)


@given(st.randoms(use_true_random=False))
def test_nearest_solution_to_the_present_pose_is_the_present_angles(
    rng: random.Random,
) -> None:
    angles = random_angles(rng)
    found = nearest(MYCOBOT_280, flange(MYCOBOT_280, angles), angles, LIMITS)
    assert found is not None
    # Not always to the last digit: with a straight wrist, two joints turn about one axis.
    assert max(abs(a - b) for a, b in zip(found, angles)) < 1e-3


@pytest.mark.parametrize(
    "angles",
    [(0, 0, 0, 0, 0, 0), (0, 0, 0, 0, -90, 0), (30, 90, 0, 0, 90, 0), (0, -90, 0, 90, -90, 170)],
    ids=["stretched", "wrist straight", "flat out", "stretched and straight"],
)
def test_singular_poses_have_a_solution(angles: tuple[float, ...]) -> None:
    reported = Pose.of(reported_coords(coords_of(MYCOBOT_280, angles)))
    for target in (flange(MYCOBOT_280, angles), reported):
        found = nearest(MYCOBOT_280, target, angles, LIMITS)
        assert found is not None
        assert flange(MYCOBOT_280, found).distance(target)[0] <= 0.22


@pytest.mark.parametrize("z", [-300.0, 500.0, 5000.0])
def test_pose_out_of_reach_has_no_solution(z: float) -> None:
    assert nearest(MYCOBOT_280, Pose.of((100, 0, z, -90, 0, -90)), (0.0,) * 6, LIMITS) is None


def test_solutions_lie_inside_the_limits_and_narrow_limits_exclude_all() -> None:
    angles = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)
    target = flange(MYCOBOT_280, angles)
    narrow = [(low, 25.0) for low, _ in LIMITS]
    found = nearest(MYCOBOT_280, target, angles, narrow)
    assert found is None or all(low <= a <= high for a, (low, high) in zip(found, narrow))
    assert nearest(MYCOBOT_280, target, angles, [(0.0, 1.0)] * 6) is None
    assert nearest(MYCOBOT_280, target, angles, [(1.0, 0.0)] * 6) is None


@pytest.mark.parametrize(("millimetres", "reachable"), [(0.15, True), (0.3, False)])
def test_stretched_arm_reaches_coordinates_that_the_wire_has_rounded(
    millimetres: float, reachable: bool
) -> None:
    stretched = flange(MYCOBOT_280, (0.0,) * 6)
    x, y, z = stretched.origin
    target = stretched._replace(origin=(x, y, z + millimetres))
    found = nearest(MYCOBOT_280, target, (10.0, -30.0, -60.0, 20.0, 5.0, 30.0), LIMITS)
    assert (found is not None) == reachable
    if found is not None:
        assert within_limits(found)
        assert flange(MYCOBOT_280, found).distance(target)[0] <= 0.22
