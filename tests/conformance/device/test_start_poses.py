"""From any start pose, a simulated arm conforms, and a wrong calculation is found.

A straight elbow or wrist hides the angles from rounded coordinates. ``POSES=500`` draws more poses
(``make conform`` does).
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from cobotwire.conformance import Result, Verdict
from cobotwire.editions import load, names
from cobotwire.editions.mycobot280.messages import SolveInvKinematics, SolveInvKinematicsReply
from cobotwire.kinematics import Pose, flange, geometry_of, nearest
from cobotwire.kinematics.closed_form import solutions
from cobotwire.protocol.limits import joint_limits
from cobotwire.protocol.table import Table
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.behaviour import Behaviour
from conformance.device.testing import permissions, prepared

Row = tuple[float, ...]
Inverse = Callable[[Table, Row, Row], Row]
WITH_GEOMETRY = [name for name in names() if geometry_of(load(name).TABLE) is not None]
SOLVING = [
    name
    for name in WITH_GEOMETRY
    if any(command.name == "solve_inv_kinematics" for command in load(name).TABLE.commands)
]
AT_REST = ("geometry", "reached at rest", "agreement", "calculation")
ROUND = (0.0, 0.0, 0.0, 10.0, -20.0, 90.0, -90.0)
STRAIGHT: list[Row] = [
    (0, 10, 0, 0, 0, 0),
    (0, 0, 0, 0, 0, 0),
    (-20, 60, -90, 10, 0, 0),
    (90, 10, 0, 10, -20, 90),
    (-20, 0, 60, -20, 0, 90),
]
BENT: list[Row] = [(20, 40, -60, 10, 50, 30), (-90, -20, 50, -20, 60, 10)]


def _poses(table: Table, count: int) -> Iterator[Row]:
    """Draw start poses: often with a straight elbow or wrist, or at a limit; nearly or exactly."""
    chance = random.Random(3)
    for _ in range(count):
        near = chance.choice((0.0, 0.0, 0.3))
        yield tuple(
            min(max(chance.choice((*ROUND, low, high)) + chance.uniform(-near, near), low), high)
            if chance.random() < 0.8
            else chance.uniform(low, high)
            for low, high in joint_limits(table)
        )


def _failures(edition: str, pose: Row, inverse: Inverse | None = None) -> list[Result]:
    """Return what fails at rest; ``inverse`` replaces the arm's calculation of angles."""
    table = load(edition).TABLE

    def solve(arm: Any, now: float, request: Any) -> Any:
        assert inverse is not None, "else the arm calculates itself"
        angles: Any = inverse(table, request.coords, request.angles)
        return SolveInvKinematicsReply(angles=angles)

    def wrap(arm: SimulatedArm) -> SimulatedArm:
        own = {"solve_inv_kinematics": Behaviour(SolveInvKinematics, solve)} if inverse else None
        made = SimulatedArm(table, clock=arm.clock, behaviours=own)
        made.state.angles.place(made.state.on_ticks(pose), made.clock())
        return made

    tester = prepared(table, wrap, permissions=permissions())
    found = [
        r for step in tester.steps() if step.group.name in AT_REST for r in tester.results(step)
    ]
    assert any(result.verdict is Verdict.PASS for result in found)
    return [result for result in found if result.verdict is Verdict.FAIL]


@pytest.mark.parametrize("edition", WITH_GEOMETRY)
def test_simulated_arm_conforms_at_rest_in_any_pose(edition: str) -> None:
    for pose in _poses(load(edition).TABLE, int(os.environ.get("POSES", "8"))):
        assert _failures(edition, pose) == [], pose


def _rounded(table: Table, coords: Row, angles: Row) -> Row:
    """Return the nearest angles that the rounded coordinates allow, without regard to limits."""
    geometry = geometry_of(table)
    assert geometry is not None
    found = nearest(geometry, Pose.of(coords), angles, [(-180.0, 180.0)] * len(angles))
    assert found is not None
    return found


def _other_branch(table: Table, coords: Row, angles: Row) -> Row:
    """Return angles that reach the pose with another shoulder, elbow or wrist."""
    geometry = geometry_of(table)
    assert geometry is not None
    target = flange(geometry, angles)
    far = [
        one
        for one in solutions(geometry, target, angles)
        if flange(geometry, one).distance(target)[0] < 0.01
        and max(abs(a - b) for a, b in zip(one, angles)) > 20
    ]
    return far[0]


WRONG: dict[str, Inverse] = {
    "scaled": lambda table, coords, angles: tuple(2 * angle for angle in angles),
    "one joint too far": lambda table, coords, angles: (*angles[:2], angles[2] + 15, *angles[3:]),
    "two joints exchanged": lambda table, coords, angles: (
        angles[0],
        angles[2],
        angles[1],
        *angles[3:],
    ),
    "another sign": lambda table, coords, angles: tuple(-angle for angle in angles),
}


@pytest.mark.parametrize("pose", STRAIGHT, ids=str)
@pytest.mark.parametrize("edition", SOLVING)
def test_calculation_with_rounded_coordinates_passes_where_they_hide_the_angles(
    edition: str, pose: Row
) -> None:
    assert _failures(edition, pose, _rounded) == []


@pytest.mark.parametrize("pose", [*STRAIGHT[:1], *STRAIGHT[2:], *BENT], ids=str)
@pytest.mark.parametrize("mistake", WRONG)
def test_wrong_calculation_is_found_in_straight_and_bent_poses(mistake: str, pose: Row) -> None:
    # Another edition for each pose: all of them would take three times as long.
    edition = SOLVING[(STRAIGHT + BENT).index(pose) % len(SOLVING)]
    [failure] = _failures(edition, pose, WRONG[mistake])
    assert failure.command == "solve_inv_kinematics"


@pytest.mark.parametrize("pose", BENT, ids=str)
@pytest.mark.parametrize("edition", SOLVING)
def test_other_solution_for_the_pose_is_found(edition: str, pose: Row) -> None:
    [failure] = _failures(edition, pose, _other_branch)
    assert failure.command == "solve_inv_kinematics"
