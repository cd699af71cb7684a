"""The gripper: one axis from closed (0) to open (100)."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import OPENING_A_SECOND, ArmState


@does("get_gripper_value")
def get_gripper_value(arm: ArmState, now: float) -> dict[str, Any]:
    """How far the gripper is open."""
    return {"value": round(arm.gripper.position(now)[0])}


@does("set_gripper_state")
def set_gripper_state(arm: ArmState, now: float, state: int, speed: int) -> None:
    """Open or close the gripper."""
    set_gripper_value(arm, now, 100 if state == 0 else 0, speed)


@does("set_gripper_value")
def set_gripper_value(arm: ArmState, now: float, value: int, speed: int) -> None:
    """Open the gripper so far. Like the joints it does not move without power."""
    if arm.powered and speed > 0:
        arm.gripper.go((float(value),), OPENING_A_SECOND * speed, now)


@does("set_gripper_calibration")
def set_gripper_calibration(arm: ArmState, now: float) -> None:
    """Take the present opening as zero."""
    arm.gripper.place((0.0,), now)


@does("is_gripper_moving")
def is_gripper_moving(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the gripper moves."""
    return {"moving": arm.gripper.moving(now)}
