"""A robot with two arms and a waist: each limb is a client, and has a state of its own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from both_ways import InLoop
from cobotwire import AsyncMyBuddy, MyBuddy, UsageError
from cobotwire.editions.mybuddy import TABLE
from cobotwire.protocol.errors import ReplyTimeout
from cobotwire.session.motion import TOLERANCES
from cobotwire.simulator import MemoryTransport, PtyServer, SimulatedArm, SteppedClock

LEFT, RIGHT = [10.0, -20.0, 30.0, -40.0, 50.0, -60.0], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]


@pytest.fixture
def robot() -> SimulatedArm:
    return SimulatedArm(TABLE, powered=True)


@pytest.fixture
def stepped() -> Iterator[tuple[MyBuddy, SimulatedArm]]:
    clock = SteppedClock()
    robot = SimulatedArm(TABLE, clock=clock, powered=True)
    with MyBuddy(MemoryTransport(robot, clock)) as client:
        yield client, robot


@pytest.mark.parametrize("asynchronous", [False, True])
def test_limbs_move_apart_over_a_port(robot: SimulatedArm, asynchronous: bool) -> None:
    with PtyServer(robot) as server:
        opened: Any = InLoop(AsyncMyBuddy, server.url) if asynchronous else MyBuddy(server.url)
        with opened as arm:
            arm.left.send_angles(LEFT, 100)
            arm.right.send_angles(RIGHT, 100)
            arm.waist.send_angle(1, 15, 100)
            arm.left.wait_until_reached(LEFT)
            arm.right.wait_until_reached(RIGHT)
            # A joint that has reached its target may still move by this much.
            near = TOLERANCES["degree"]
            assert arm.left.get_angles() == pytest.approx(LEFT, abs=near)
            assert arm.right.get_angles() == pytest.approx(RIGHT, abs=near)
            assert arm.waist.get_angle(1) == pytest.approx(15, abs=near)


def test_waist_has_one_joint(stepped: tuple[MyBuddy, SimulatedArm]) -> None:
    arm, robot = stepped
    assert robot.state_at("waist").joints == 1
    with pytest.raises(UsageError, match="rows of 6 values, and WAIST has 1 joint"):
        arm.waist.get_angles()
    arm.waist.send_angle(2, 30, 50)
    with pytest.raises(ReplyTimeout):
        arm.waist.get_angle(2)
    assert "WAIST has no joint 2" in robot.notes[-1].text


def test_queries_of_coordinates_have_no_reply(stepped: tuple[MyBuddy, SimulatedArm]) -> None:
    arm, robot = stepped
    for query in (arm.left.get_coords, arm.left.get_base_coord, arm.get_base_coords):
        with pytest.raises(ReplyTimeout):
            query()
    assert sum("lengths of the links" in note.text for note in robot.notes) >= 3
