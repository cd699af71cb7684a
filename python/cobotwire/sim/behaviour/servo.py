"""Servo positions, joint limits, servo registers, and single servos."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.gripper import set_gripper_value
from cobotwire.sim.behaviour.motion import send_angle
from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.kinematics.ticks import ZERO_TICK
from cobotwire.sim.state import ArmState
from cobotwire.sim.targets import go_to_angles


@does("set_encoder")
def set_encoder(
    arm: ArmState, now: float, joint: int, encoder: int, speed: int | None = None
) -> None:
    """Move one servo, at its speed or the one that is set; the one behind the last: the gripper.

    No source says what a gripper's encoder reads. Here it is the middle when closed, and a step
    more for each percent that it is open.
    """
    chosen = arm.speed if speed is None else speed
    if joint <= arm.joints:
        send_angle(arm, now, joint, arm.angle_at(joint - 1, encoder), chosen)
    elif 0 <= encoder - ZERO_TICK <= 100:
        set_gripper_value(arm, now, encoder - ZERO_TICK, chosen)
    else:
        low, high = ZERO_TICK, ZERO_TICK + 100
        arm.remarks.append(f"refused: the gripper's encoder goes from {low} to {high}")


@does("get_encoder")
def get_encoder(arm: ArmState, now: float, joint: int) -> dict[str, Any]:
    """Where one servo stands."""
    return {"encoder": arm.encoder(joint - 1, now)}


@does("set_encoders")
def set_encoders(arm: ArmState, now: float, encoders: tuple[int, ...], speed: int) -> None:
    """Move all servos."""
    target = tuple(arm.angle_at(joint, tick) for joint, tick in enumerate(encoders))
    go_to_angles(arm, target, speed, now)


@does("get_encoders")
def get_encoders(arm: ArmState, now: float) -> dict[str, Any]:
    """Where all servos stand."""
    return {"encoders": [arm.encoder(joint, now) for joint in range(arm.joints)]}


@does("get_joint_min_angle")
def get_joint_min_angle(arm: ArmState, now: float, joint: int) -> dict[str, Any]:
    """A joint's smallest angle."""
    return {"angle": arm.minimum[joint - 1]}


@does("get_joint_max_angle")
def get_joint_max_angle(arm: ArmState, now: float, joint: int) -> dict[str, Any]:
    """A joint's largest angle."""
    return {"angle": arm.maximum[joint - 1]}


@does("set_joint_min")
def set_joint_min(arm: ArmState, now: float, joint: int, angle: float) -> None:
    """Set a joint's smallest angle."""
    arm.minimum[joint - 1] = angle
    _mind_limits(arm, now)


@does("set_joint_max")
def set_joint_max(arm: ArmState, now: float, joint: int, angle: float) -> None:
    """Set a joint's largest angle."""
    arm.maximum[joint - 1] = angle
    _mind_limits(arm, now)


@does("is_servo_enable")
def is_servo_enable(arm: ArmState, now: float, joint: int) -> dict[str, Any]:
    """Whether one servo is powered."""
    return {"enabled": arm.enabled[joint - 1]}


@does("is_all_servo_enable")
def is_all_servo_enable(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether all servos are powered."""
    return {"enabled": all(arm.enabled)}


@does("set_servo_data")
def set_servo_data(
    arm: ArmState, now: float, joint: int, register: int, value: int, mode: int = 0
) -> None:
    """Write a servo register."""
    arm.registers[joint - 1][register] = value


@does("get_servo_data")
def get_servo_data(
    arm: ArmState, now: float, joint: int, register: int, mode: int = 0
) -> dict[str, Any]:
    """Read a servo register: its low byte, or with mode 1 all of it."""
    value = arm.registers[joint - 1].get(register, 0)
    return {"value": value if mode else value % 256}


@does("set_servo_calibration")
def set_servo_calibration(arm: ArmState, now: float, joint: int) -> None:
    """Take a joint's present position as its zero."""
    if joint > arm.joints:
        arm.gripper.place((0.0,), now)
        return
    position = list(arm.angles.position(now))
    position[joint - 1] = 0.0
    arm.angles.place(position, now)


@does("joint_brake")
def joint_brake(arm: ArmState, now: float, joint: int) -> None:
    """Hold a joint where it stands; the others, which move with it, stand too."""
    arm.angles.brake(now)


@does("release_servo")
def release_servo(arm: ArmState, now: float, joint: int, undamped: int = 0) -> None:
    """Let go of one joint."""
    if joint <= arm.joints:
        arm.angles.halt(now)
        arm.enabled[joint - 1] = False


@does("focus_servo")
def focus_servo(arm: ArmState, now: float, joint: int) -> None:
    """Hold one joint."""
    if joint <= arm.joints:
        arm.enabled[joint - 1] = arm.powered


def _mind_limits(arm: ArmState, now: float) -> None:
    """A motion that would lead a joint beyond its new limits ends."""
    pairs = zip(arm.angles.stop_at(now), arm.angles.target(now), arm.limits())
    if any(at != to and not low <= to <= high for at, to, (low, high) in pairs):
        arm.angles.brake(now)
        arm.remarks.append("stopped: the motion leads beyond the new limits")
