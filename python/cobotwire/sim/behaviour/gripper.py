"""The gripper: one axis from closed (0) to open (100)."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import OPENING_A_SECOND, ArmState

OPEN, CLOSE = 0, 1


@does("get_gripper_value")
def get_gripper_value(arm: ArmState, now: float, gripper: int = 1) -> dict[str, Any]:
    """How far the gripper is open; there is one gripper, whatever kind is asked for."""
    return {"value": round(arm.gripper.position(now)[0])}


@does("set_gripper_state")
def set_gripper_state(arm: ArmState, now: float, state: int, speed: int, **kind: int) -> None:
    """Open or close the gripper; released, it stays where it stands."""
    if state in (OPEN, CLOSE):
        set_gripper_value(arm, now, 100 if state == OPEN else 0, speed)
    else:
        arm.gripper.halt(now)


@does("set_gripper_value")
def set_gripper_value(arm: ArmState, now: float, value: int, speed: int, **kind: int) -> None:
    """Open the gripper so far. Like the joints it does not move without power."""
    if arm.powered and speed > 0:
        arm.gripper.go((float(value),), OPENING_A_SECOND * speed, now)
    else:
        arm.remarks.append("ignored: the gripper has no power, or its speed is 0")


@does("set_gripper_calibration")
def set_gripper_calibration(arm: ArmState, now: float) -> None:
    """Take the present opening as zero."""
    arm.gripper.place((0.0,), now)


@does("is_gripper_moving")
def is_gripper_moving(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the gripper moves."""
    return {"moving": arm.gripper.moving(now)}


@does("init_gripper")
def init_gripper(arm: ArmState, now: float) -> dict[str, Any]:
    """Find the gripper's ends: it stands open afterwards."""
    arm.gripper.place((100.0,), now)
    return {"succeeded": True}


@does("set_HTS_gripper_torque")
def set_hts_gripper_torque(arm: ArmState, now: float, torque: int) -> dict[str, Any]:
    """Set the torque of the adaptive gripper."""
    arm.settings.gripper_torque = torque
    return {"succeeded": True}


@does("get_HTS_gripper_torque")
def get_hts_gripper_torque(arm: ArmState, now: float) -> dict[str, Any]:
    """The torque of the adaptive gripper."""
    return {"torque": arm.settings.gripper_torque}


@does("set_gripper_protect_current")
def set_gripper_protect_current(arm: ArmState, now: float, current: int) -> None:
    """Set the current at which the gripper protects itself."""
    arm.settings.gripper_current = current


@does("get_gripper_protect_current")
def get_gripper_protect_current(arm: ArmState, now: float) -> dict[str, Any]:
    """The current at which the gripper protects itself."""
    return {"current": arm.settings.gripper_current}
