"""Test inverse kinematics without a closed form, for several arms and random geometries."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire.kinematics import Effort, Geometry, Link, Pose, flange, nearest
from cobotwire.kinematics import search as searches
from kinematic_samples import LIMITS, MYCOBOT_280, random_angles, within_limits

Row = tuple[float, float, float, float]
ELBOW: tuple[Row, ...] = ((0, -90, 0, 138), (-90, 0, 100, 0), (0, -90, 5, 0), (0, 90, 0, 107))
SHOULDER: tuple[Row, ...] = (
    (0, -90, 0, 175),
    (0, 90, 0, 0),
    (180, -90, 30, 205),
    (180, 90, -30, 0),
)
# Offset, alpha, a and d of each link. The joints of these arms are arranged unlike the 280's.
ARMS: dict[str, tuple[Row, ...]] = {
    "five joints": ((0, 90, 0, 100), *((0, 0, 120, 0),) * 2, (0, 90, 0, 0), (0, 0, 0, 80)),
    "six joints with a spherical wrist": (*ELBOW, (0, -90, 0, 0), (0, 0, 0, 60)),
    "six skew joints": tuple(
        (offset, alpha + 17, a + 9, d)
        for offset, alpha, a, d in (*ELBOW, (0, -90, 0, 0), (0, 0, 0, 60))
    ),
    "seven joints": (*SHOULDER, (180, 90, 0, 206), (90, 90, 38, 0), (0, 0, 0, 46)),
}
# An end that stays level: its link turns back by the angles of the second and the third joint.
LEVEL = Geometry(
    (
        Link(0, 90, 0, 120),
        Link(90, 0, 140, 0),
        Link(-90, 0, 134, 0),
        Link(0, 90, 44, 0, ((1, -1.0), (2, -1.0))),
        Link(0, 0, 0, -20, ((3, 1.0),)),
    )
)
WIDE = (-160.0, 160.0)
# As many steps as a search from all its starting points needs.
ENOUGH = 3000

lengths = st.integers(0, 200).map(float)
alphas = st.sampled_from([-90.0, 0.0, 90.0]) | st.integers(-180, 180).map(float)
links = st.builds(Link, st.integers(-180, 180).map(float), alphas, lengths, lengths)
geometries = st.lists(links, min_size=4, max_size=7).map(lambda rows: Geometry(tuple(rows)))


def search(
    geometry: Geometry,
    target: Pose,
    present: Sequence[float],
    limits: list[tuple[float, float]],
    largest_turn: float = math.inf,
) -> tuple[float, ...] | None:
    """Return the result of a search without a limit of effort."""
    return searches.search(geometry, target, present, limits, largest_turn, Effort(ENOUGH))


def _reached(
    geometry: Geometry, target: Pose, present: list[float], limits: list[tuple[float, float]]
) -> tuple[float, float]:
    """Return how many millimetres and degrees the solution is from a target inside the reach."""
    found = nearest(geometry, target, present, limits, effort=Effort(ENOUGH))
    assert found is not None
    assert all(low <= angle <= high for angle, (low, high) in zip(found, limits))
    return flange(geometry, found).distance(target)


@pytest.mark.parametrize("name", ARMS)
def test_pose_is_found_from_any_other_pose(name: str) -> None:
    rows, rng = ARMS[name], random.Random(5)
    geometry, limits = (
        Geometry(tuple(Link(*row) for row in rows)),
        [WIDE] * len(rows),
    )
    for _ in range(20):
        angles, present = ([rng.uniform(*WIDE) for _ in rows] for _ in range(2))
        target = flange(geometry, angles)
        assert max(_reached(geometry, target, present, limits)) <= 1e-3


@settings(max_examples=100)
@given(geometries, st.randoms(use_true_random=False))
def test_pose_near_the_present_one_is_found_with_any_geometry(
    geometry: Geometry, rng: random.Random
) -> None:
    limits = [WIDE] * len(geometry.links)
    angles = [rng.uniform(-150, 150) for _ in limits]
    present = [angle + rng.uniform(-5, 5) for angle in angles]
    way, turn = _reached(geometry, flange(geometry, angles), present, limits)
    assert way <= 0.22
    assert turn <= 0.03


@pytest.mark.parametrize("name", ARMS)
def test_search_along_a_path_finds_the_next_point_and_excludes_jumps(name: str) -> None:
    rows, rng = ARMS[name], random.Random(6)
    geometry, limits = Geometry(tuple(Link(*row) for row in rows)), [WIDE] * len(rows)
    jumps = 0
    for _ in range(6):
        present, far = ([rng.uniform(-150, 150) for _ in rows] for _ in range(2))
        next_point = flange(geometry, [angle + rng.uniform(-3, 3) for angle in present])
        found = search(geometry, next_point, present, limits, 30.0)
        assert found is not None
        assert found == search(geometry, next_point, present, limits)
        elsewhere = flange(geometry, far)
        found, whole = (search(geometry, elsewhere, present, limits, t) for t in (30.0, math.inf))
        assert found in (None, whole)
        jumps += found is None and whole is not None
    assert jumps > 0


def test_search_finds_what_the_closed_form_finds() -> None:
    rng = random.Random(8)
    for _ in range(10):
        target = flange(MYCOBOT_280, random_angles(rng))
        found = search(MYCOBOT_280, target, random_angles(rng), LIMITS)
        assert found is not None
        assert within_limits(found)
        assert max(flange(MYCOBOT_280, found).distance(target)) <= 1e-3


def test_link_without_a_joint_of_its_own_keeps_the_end_level() -> None:
    rng = random.Random(4)
    limits = [(-160.0, 160.0), (0.0, 90.0), (-90.0, 60.0), (-180.0, 180.0)]
    for _ in range(20):
        angles, present = ([rng.uniform(*pair) for pair in limits] for _ in range(2))
        target = flange(LEVEL, angles)
        assert abs(target.z[2]) == pytest.approx(1)
        assert max(_reached(LEVEL, target, present, limits)) <= 1e-3


def test_tilted_end_has_no_solution_if_the_end_stays_level() -> None:
    x, y, z, rx, ry, rz = flange(LEVEL, (10.0, 30.0, -20.0, 40.0)).coords
    tilted = Pose.of((x, y, z, rx + 10, ry, rz))
    assert search(LEVEL, tilted, (0.0,) * 4, [WIDE] * 4) is None


def test_pose_out_of_reach_or_of_the_limits_has_no_solution() -> None:
    rows = ARMS["seven joints"]
    geometry = Geometry(tuple(Link(*row) for row in rows))
    far = Pose.of((100, 0, 5000, 0, 0, 0))
    assert search(geometry, far, (0.0,) * 7, [WIDE] * 7) is None
    target = flange(geometry, (50.0,) * 7)
    assert search(geometry, target, (0.0,) * 7, [(0.0, 10.0)] * 7) is None
    assert search(geometry, target, (50.0,) * 7, [(60.0, 40.0)] * 7) is None
