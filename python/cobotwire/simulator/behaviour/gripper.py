"""The gripper: one axis from closed (0) to open (100)."""

from __future__ import annotations

from cobotwire.editions.mycobot280.enums import GripperState
from cobotwire.editions.mycobot280.messages import (
    GetGripperProtectCurrent,
    GetGripperProtectCurrentReply,
    GetGripperValue,
    GetGripperValueReply,
    GetHTSGripperTorque,
    GetHTSGripperTorqueReply,
    InitGripper,
    InitGripperReply,
    IsGripperMoving,
    IsGripperMovingReply,
    SetGripperCalibration,
    SetGripperProtectCurrent,
    SetGripperState,
    SetGripperValue,
    SetHTSGripperTorque,
    SetHTSGripperTorqueReply,
)
from cobotwire.simulator.behaviour.registry import behaviour
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import move_gripper


@behaviour(GetGripperValue)
def get_gripper_value(arm: ArmState, now: float, request: GetGripperValue) -> GetGripperValueReply:
    """Reply with how far the gripper is open; there is one gripper, whatever kind is requested."""
    return GetGripperValueReply(value=round(arm.gripper.position(now)[0]))


@behaviour(SetGripperState)
def set_gripper_state(arm: ArmState, now: float, request: SetGripperState) -> None:
    """Open or close the gripper; a released one stays where it is."""
    if request.state in (GripperState.OPEN, GripperState.CLOSE):
        move_gripper(arm, 100 if request.state == GripperState.OPEN else 0, request.speed, now)
    else:
        arm.gripper.halt(now)


@behaviour(SetGripperValue)
def set_gripper_value(arm: ArmState, now: float, request: SetGripperValue) -> None:
    """Move the gripper to an opening."""
    move_gripper(arm, request.value, request.speed, now)


@behaviour(SetGripperCalibration)
def set_gripper_calibration(arm: ArmState, now: float, request: SetGripperCalibration) -> None:
    """Take the present opening as zero."""
    arm.gripper.place((0.0,), now)


@behaviour(IsGripperMoving)
def is_gripper_moving(arm: ArmState, now: float, request: IsGripperMoving) -> IsGripperMovingReply:
    """Reply whether the gripper moves."""
    return IsGripperMovingReply(moving=arm.gripper.moving(now))


@behaviour(InitGripper)
def init_gripper(arm: ArmState, now: float, request: InitGripper) -> InitGripperReply:
    """Find the gripper's ends; it is open afterwards."""
    arm.gripper.place((100.0,), now)
    return InitGripperReply(succeeded=True)


@behaviour(SetHTSGripperTorque)
def set_hts_gripper_torque(
    arm: ArmState, now: float, request: SetHTSGripperTorque
) -> SetHTSGripperTorqueReply:
    """Set the torque of the adaptive gripper."""
    arm.settings.gripper_torque = request.torque
    return SetHTSGripperTorqueReply(succeeded=True)


@behaviour(GetHTSGripperTorque)
def get_hts_gripper_torque(
    arm: ArmState, now: float, request: GetHTSGripperTorque
) -> GetHTSGripperTorqueReply:
    """Reply with the torque of the adaptive gripper."""
    return GetHTSGripperTorqueReply(torque=arm.settings.gripper_torque)


@behaviour(SetGripperProtectCurrent)
def set_gripper_protect_current(
    arm: ArmState, now: float, request: SetGripperProtectCurrent
) -> None:
    """Set the current at which the gripper protects itself."""
    arm.settings.gripper_current = request.current


@behaviour(GetGripperProtectCurrent)
def get_gripper_protect_current(
    arm: ArmState, now: float, request: GetGripperProtectCurrent
) -> GetGripperProtectCurrentReply:
    """Reply with the current at which the gripper protects itself."""
    return GetGripperProtectCurrentReply(current=arm.settings.gripper_current)
