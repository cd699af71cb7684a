"""The older classes drive arms that acknowledge nothing, and arms that do."""

from __future__ import annotations

import pytest

from cobotwire.protocol.errors import MotionTimeout
from layer.arms import made


@pytest.mark.parametrize("edition", ["mycobot", "mycobot280"])
@pytest.mark.parametrize(("name", "result"), [("MyCobot", 1), ("MyCobotSocket", [1])])
def test_setter_returns_at_once_whether_or_not_the_arm_acknowledges(
    name: str, result: object, edition: str
) -> None:
    arm, _ = made(name, robot=edition)
    before = arm.clock()
    assert arm.send_angles([0, 10, 0, 0, 0, 0], 50) == result
    assert arm.clock() == before
    assert arm.is_power_on() == 1


def test_motion_that_is_late_returns_0_or_raises() -> None:
    with pytest.raises(MotionTimeout):
        made("MyCobot")[0].sync_send_angles([90, 0, 0, 0, 0, 0], 1, 0.5)
    late, _ = made("MyCobot", errors="return")
    assert late.sync_send_angles([90, 0, 0, 0, 0, 0], 1, 0.5) == 0
    assert late.sync_send_angles([90, 0, 0, 0, 0, 0], 100) == 1


def test_home_of_the_socket_class_waits() -> None:
    arm, _ = made("MyCobotSocket")
    arm.sync_send_angles([20, 0, 0, 0, 0, 0], 100)
    assert arm.go_home() is None
    assert all(abs(angle) < 0.1 for angle in arm.get_angles())
    assert made("MyCobot")[0].go_home() == 1


def test_chain_of_motions_returns_the_arm() -> None:
    arm, _ = made("MyPalletizer")
    assert arm.sync_send_angles([10, 0, 0, 0], 100).wait(0) is arm
