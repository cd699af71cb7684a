"""Test sorting.py on a simulated arm: pytest test_sorting.py.

The fixture simulated_arm comes with cobotwire. Its arm has a clock that each wait advances, so
motions of many seconds are over at once.
"""

import pytest
from sorting import HEAVY, LIGHT, drop

from cobotwire import MotionTimeout, MyCobot280


@pytest.mark.parametrize(
    ("grams", "box", "pose"), [(100, "light", LIGHT), (101, "heavy", HEAVY), (250, "heavy", HEAVY)]
)
def test_part_is_dropped_into_its_box(
    simulated_arm: MyCobot280, grams: float, box: str, pose: list[float]
) -> None:
    """The arm stands above the box, and the gripper is open."""
    simulated_arm.power_on()
    assert drop(simulated_arm, grams) == box
    assert simulated_arm.get_angles() == pytest.approx(pose, abs=0.2)
    assert simulated_arm.get_gripper_value() == 100


def test_part_that_is_too_heavy_does_not_move_the_arm(simulated_arm: MyCobot280) -> None:
    """The error comes before the first request."""
    simulated_arm.power_on()
    with pytest.raises(ValueError, match="the arm carries 250 g"):
        drop(simulated_arm, 251)
    assert simulated_arm.get_angles() == (0,) * 6


def test_arm_without_power_is_an_error(simulated_arm: MyCobot280) -> None:
    """The error says why the arm does not move."""
    with pytest.raises(MotionTimeout, match="power"):
        drop(simulated_arm, 50)
