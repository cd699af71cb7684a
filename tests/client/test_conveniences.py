"""Conveniences besides the commands: defaults, home, the gripper, names of joints."""

from __future__ import annotations

import inspect
from typing import Any

import pytest

from cobotwire import Joint, MyCobot280
from cobotwire.editions import load
from cobotwire.editions.mycobot280 import AsyncMyCobot280
from cobotwire.protocol.errors import MotionTimeout, UsageError
from cobotwire.simulator import MemoryTransport, SimulatedArm
from cobotwire.simulator.clock import SteppedClock


class Driven:
    """A client of a simulated arm, in stepped time."""

    def __init__(self, edition: str = "mycobot280", powered: bool = True) -> None:
        self.clock = SteppedClock()
        found = load(edition)
        self.simulated = SimulatedArm(found.TABLE, clock=self.clock, powered=powered)
        self.arm: Any = found.CLIENT(MemoryTransport(self.simulated, self.clock))

    def opening(self) -> float:
        return self.simulated.state.gripper.position(self.clock())[0]


@pytest.mark.parametrize("edition", ["mycobot", "mycobot280", "mypalletizer260"])
def test_home_is_where_all_joints_are_at_zero(edition: str) -> None:
    driven = Driven(edition)
    joints = driven.simulated.table.joints
    driven.arm.move_angles([20] * joints, 100)
    driven.arm.go_home()
    assert max(map(abs, driven.arm.get_angles())) <= 0.5
    driven.arm.move_angles([20] * joints, 100)
    started = driven.clock()
    driven.arm.go_home(speed=1, wait=False)
    assert driven.clock() - started < 0.1
    assert driven.arm.is_moving()


def test_home_that_is_not_reached_is_an_error() -> None:
    driven = Driven()
    driven.arm.move_angles([20] * 6, 100)
    with pytest.raises(MotionTimeout):
        driven.arm.go_home(speed=1, timeout=0.5)


@pytest.mark.parametrize("edition", ["mycobot", "mycobot280", "mypalletizer260"])
def test_gripper_opens_and_closes(edition: str) -> None:
    driven = Driven(edition)
    driven.arm.close_gripper()
    driven.clock.sleep(5)
    assert driven.opening() == 0
    driven.arm.open_gripper(speed=100)
    driven.clock.sleep(5)
    assert driven.opening() == 100
    with pytest.raises(UsageError, match="speed is 101"):
        driven.arm.open_gripper(speed=101)


@pytest.mark.parametrize("codec", ["native", "reference"])
def test_joints_have_names(codec: str) -> None:
    driven = Driven()
    arm = MyCobot280(MemoryTransport(driven.simulated, driven.clock), codec=codec)  # type: ignore[arg-type]
    assert arm.get_encoder(Joint.J2) == arm.get_encoder(2)
    with pytest.raises(UsageError, match="joint is "):
        arm.send_angle(Joint.J7, 0, 50)


def test_baud_rate_is_the_second_argument() -> None:
    for client in (MyCobot280, AsyncMyCobot280):
        second = list(inspect.signature(client).parameters.values())[1]
        assert (second.name, second.kind) == ("baudrate", second.POSITIONAL_OR_KEYWORD)
