"""The gripper: one axis from closed (0) to open (100)."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.editions.mycobot280.enums import GripperState
from cobotwire.simulator.behaviour.registry import behaviour, query, reported
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import move_gripper

# There is one gripper, whatever kind is requested.
query(m.GetGripperValue, lambda arm, now, request: round(arm.gripper.position(now)[0]))


@behaviour(m.SetGripperState)
def set_gripper_state(arm: ArmState, now: float, request: m.SetGripperState) -> None:
    """Open or close the gripper; a released one stays where it is."""
    if request.state in (GripperState.OPEN, GripperState.CLOSE):
        move_gripper(arm, 100 if request.state == GripperState.OPEN else 0, request.speed, now)
    else:
        arm.gripper.halt(now)


@behaviour(m.SetGripperValue)
def set_gripper_value(arm: ArmState, now: float, request: m.SetGripperValue) -> None:
    """Move the gripper to an opening."""
    move_gripper(arm, request.value, request.speed, now)


@behaviour(m.SetGripperCalibration)
def set_gripper_calibration(arm: ArmState, now: float, request: m.SetGripperCalibration) -> None:
    """Take the present opening as zero."""
    arm.gripper.place((0.0,), now)


query(m.IsGripperMoving, lambda arm, now, request: arm.gripper.moving(now))


@behaviour(m.InitGripper)
def init_gripper(arm: ArmState, now: float, request: m.InitGripper) -> m.InitGripperReply:
    """Find the gripper's ends; it is open afterwards."""
    arm.gripper.place((100.0,), now)
    return m.InitGripperReply(succeeded=True)


@behaviour(m.SetHTSGripperTorque)
def set_hts_gripper_torque(
    arm: ArmState, now: float, request: m.SetHTSGripperTorque
) -> m.SetHTSGripperTorqueReply:
    """Set the torque of the adaptive gripper."""
    arm.gripper_torque = request.torque
    return m.SetHTSGripperTorqueReply(succeeded=True)


query(m.GetHTSGripperTorque, lambda arm, now, request: arm.gripper_torque)
reported(m.GetHTSGripperTorque, torque="gripper_torque")
