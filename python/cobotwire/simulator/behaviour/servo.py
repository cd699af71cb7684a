"""Servo positions, joint limits, servo registers, and single servos."""

from __future__ import annotations

from cobotwire.editions.mycobot280.messages import (
    FocusServo,
    GetEncoder,
    GetEncoderReply,
    GetEncoders,
    GetEncodersReply,
    GetJointMaxAngle,
    GetJointMaxAngleReply,
    GetJointMinAngle,
    GetJointMinAngleReply,
    GetServoData,
    GetServoDataReply,
    IsAllServoEnable,
    IsAllServoEnableReply,
    IsServoEnable,
    IsServoEnableReply,
    JointBrake,
    ReleaseServo,
    SetEncoder,
    SetEncoders,
    SetJointMax,
    SetJointMin,
    SetServoCalibration,
    SetServoData,
)
from cobotwire.simulator.behaviour.registry import behaviour, row
from cobotwire.simulator.kinematics.ticks import ZERO_TICK
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_angle, go_to_angles, move_gripper


@behaviour(SetEncoder)
def set_encoder(arm: ArmState, now: float, request: SetEncoder) -> None:
    """Move one servo; the number after the last joint is the gripper.

    No source defines the reading of a gripper's encoder. Here it is the middle of the range when
    closed, plus one tick for each percent of opening.
    """
    joint, encoder = request.joint, request.encoder
    # The request of older editions has no speed; the speed that is set applies.
    own_speed: int | None = request.speed
    speed = arm.speed if own_speed is None else own_speed
    if joint <= arm.joints:
        go_to_angle(arm, joint, arm.angle_at(joint - 1, encoder), speed, now)
    elif 0 <= encoder - ZERO_TICK <= 100:
        move_gripper(arm, encoder - ZERO_TICK, speed, now)
    else:
        low, high = ZERO_TICK, ZERO_TICK + 100
        arm.remarks.append(f"rejected: the gripper's encoder goes from {low} to {high}")


@behaviour(GetEncoder)
def get_encoder(arm: ArmState, now: float, request: GetEncoder) -> GetEncoderReply:
    """Reply with the position of one servo."""
    return GetEncoderReply(encoder=arm.encoder(request.joint - 1, now))


@behaviour(SetEncoders)
def set_encoders(arm: ArmState, now: float, request: SetEncoders) -> None:
    """Move all servos."""
    target = tuple(arm.angle_at(joint, tick) for joint, tick in enumerate(request.encoders))
    go_to_angles(arm, target, request.speed, now)


@behaviour(GetEncoders)
def get_encoders(arm: ArmState, now: float, request: GetEncoders) -> GetEncodersReply:
    """Reply with the positions of all servos."""
    return GetEncodersReply(encoders=row(arm.encoder(joint, now) for joint in range(arm.joints)))


@behaviour(GetJointMinAngle)
def get_joint_min_angle(
    arm: ArmState, now: float, request: GetJointMinAngle
) -> GetJointMinAngleReply:
    """Reply with a joint's smallest angle."""
    return GetJointMinAngleReply(angle=arm.minimum[request.joint - 1])


@behaviour(GetJointMaxAngle)
def get_joint_max_angle(
    arm: ArmState, now: float, request: GetJointMaxAngle
) -> GetJointMaxAngleReply:
    """Reply with a joint's largest angle."""
    return GetJointMaxAngleReply(angle=arm.maximum[request.joint - 1])


@behaviour(SetJointMin)
def set_joint_min(arm: ArmState, now: float, request: SetJointMin) -> None:
    """Set a joint's smallest angle."""
    arm.minimum[request.joint - 1] = request.angle
    _obey_limits(arm, now)


@behaviour(SetJointMax)
def set_joint_max(arm: ArmState, now: float, request: SetJointMax) -> None:
    """Set a joint's largest angle."""
    arm.maximum[request.joint - 1] = request.angle
    _obey_limits(arm, now)


@behaviour(IsServoEnable)
def is_servo_enable(arm: ArmState, now: float, request: IsServoEnable) -> IsServoEnableReply:
    """Reply whether one servo is powered."""
    return IsServoEnableReply(enabled=arm.enabled[request.joint - 1])


@behaviour(IsAllServoEnable)
def is_all_servo_enable(
    arm: ArmState, now: float, request: IsAllServoEnable
) -> IsAllServoEnableReply:
    """Reply whether all servos are powered."""
    return IsAllServoEnableReply(enabled=all(arm.enabled))


@behaviour(SetServoData)
def set_servo_data(arm: ArmState, now: float, request: SetServoData) -> None:
    """Write a servo register."""
    arm.registers[request.joint - 1][request.register] = request.value


@behaviour(GetServoData)
def get_servo_data(arm: ArmState, now: float, request: GetServoData) -> GetServoDataReply:
    """Reply with a servo register: its low byte, or with mode 1 all of it."""
    value = arm.registers[request.joint - 1].get(request.register, 0)
    return GetServoDataReply(value=value if request.mode else value % 256)


@behaviour(SetServoCalibration)
def set_servo_calibration(arm: ArmState, now: float, request: SetServoCalibration) -> None:
    """Take the present position of a joint as its zero."""
    if request.joint > arm.joints:
        arm.gripper.place((0.0,), now)
        return
    position = list(arm.angles.position(now))
    position[request.joint - 1] = 0.0
    arm.angles.place(position, now)


@behaviour(JointBrake)
def joint_brake(arm: ArmState, now: float, request: JointBrake) -> None:
    """Stop a joint; the others, which move together with it, stop too."""
    arm.angles.brake(now)


@behaviour(ReleaseServo)
def release_servo(arm: ArmState, now: float, request: ReleaseServo) -> None:
    """Release one joint."""
    if request.joint <= arm.joints:
        arm.angles.halt(now)
        arm.enabled[request.joint - 1] = False


@behaviour(FocusServo)
def focus_servo(arm: ArmState, now: float, request: FocusServo) -> None:
    """Hold one joint."""
    if request.joint <= arm.joints:
        arm.enabled[request.joint - 1] = arm.powered


def _obey_limits(arm: ArmState, now: float) -> None:
    """End a motion that would lead a joint beyond its new limits."""
    pairs = zip(arm.angles.stop_at(now), arm.angles.target(now), arm.limits())
    if any(at != to and not low <= to <= high for at, to, (low, high) in pairs):
        arm.angles.brake(now)
        arm.remarks.append("stopped: the motion leads beyond the new limits")
