"""Servo positions, joint limits, servo registers, and single servos."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.editions.mycobot280.enums import ServoDataMode
from cobotwire.simulator.behaviour.registry import Sized, behaviour, query, row
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_encoders, move_gripper


@behaviour(m.SetEncoder)
def set_encoder(arm: ArmState, now: float, request: m.SetEncoder) -> None:
    """Move one servo; the number after the last joint is the gripper.

    Its edition states what its encoder reads when it is closed and open.
    """
    joint, encoder = request.joint, request.encoder
    # The request of older editions has no speed; the speed that is set applies.
    own_speed: int | None = request.speed
    speed = arm.speed if own_speed is None else own_speed
    if joint <= arm.joints:
        go_to_encoders(arm, {joint - 1: encoder}, speed, now)
    elif 0 <= arm.opening_at(encoder) <= 100:
        move_gripper(arm, arm.opening_at(encoder), speed, now)
    else:
        low, high = sorted((arm.gripper_facts.closed, arm.gripper_facts.open))
        arm.remarks.append(f"rejected: the gripper's encoder goes from {low} to {high}")


query(m.GetEncoder, lambda arm, now, request: arm.encoder(request.joint - 1, now))


@behaviour(m.SetEncoders)
def set_encoders(arm: ArmState, now: float, request: m.SetEncoders) -> None:
    """Move all servos."""
    go_to_encoders(arm, dict(enumerate(request.encoders)), request.speed, now)


query(
    m.GetEncoders,
    lambda arm, now, request: row(arm.encoder(joint, now) for joint in range(arm.joints)),
)
query(m.GetJointMinAngle, lambda arm, now, request: arm.minimum[request.joint - 1])
query(m.GetJointMaxAngle, lambda arm, now, request: arm.maximum[request.joint - 1])


@behaviour(m.SetJointMin)
def set_joint_min(arm: ArmState, now: float, request: m.SetJointMin) -> None:
    """Set a joint's smallest angle."""
    arm.minimum[request.joint - 1] = request.angle
    _obey_limits(arm, now)


@behaviour(m.SetJointMax)
def set_joint_max(arm: ArmState, now: float, request: m.SetJointMax) -> None:
    """Set a joint's largest angle."""
    arm.maximum[request.joint - 1] = request.angle
    _obey_limits(arm, now)


# The number after the last joint is the gripper's servo, which is always connected.
query(m.IsServoEnable, lambda arm, now, request: [*arm.enabled, True][request.joint - 1])
query(m.IsAllServoEnable, lambda arm, now, request: all(arm.enabled))


@behaviour(m.SetServoData)
def set_servo_data(arm: ArmState, now: float, request: m.SetServoData) -> None:
    """Write a servo register."""
    arm.registers[request.joint - 1][request.register] = request.value


@behaviour(m.GetServoData)
def get_servo_data(arm: ArmState, now: float, request: m.GetServoData) -> Sized:
    """Reply with a servo register: its low byte, or with mode 1 always two bytes."""
    value = arm.registers[request.joint - 1].get(request.register, 0)
    if request.mode == ServoDataMode.WORD:
        return Sized(m.GetServoDataReply(value=value), 2)
    return Sized(m.GetServoDataReply(value=value % 256), 1)


@behaviour(m.SetServoCalibration)
def set_servo_calibration(arm: ArmState, now: float, request: m.SetServoCalibration) -> None:
    """Take the present position of a joint as its zero."""
    if request.joint > arm.joints:
        arm.gripper.place((0.0,), now)
        return
    position = list(arm.angles.position(now))
    position[request.joint - 1] = 0.0
    arm.angles.place(position, now)


@behaviour(m.JointBrake)
def joint_brake(arm: ArmState, now: float, request: m.JointBrake) -> None:
    """Stop a joint; the others, which move together with it, stop too."""
    arm.angles.brake(now)


@behaviour(m.ReleaseServo)
def release_servo(arm: ArmState, now: float, request: m.ReleaseServo) -> None:
    """Release one joint."""
    if request.joint <= arm.joints:
        arm.enabled[request.joint - 1] = False
        arm.release(now)


@behaviour(m.FocusServo)
def focus_servo(arm: ArmState, now: float, request: m.FocusServo) -> None:
    """Hold one joint."""
    if request.joint <= arm.joints:
        led, arm.enabled[request.joint - 1] = arm.released, arm.powered
        if led:
            arm.hold(now)


def _obey_limits(arm: ArmState, now: float) -> None:
    """End a motion that would lead a joint beyond its new limits."""
    angles = arm.angles
    points = [angles.position(now), angles.stop_at(now), *angles.ways(now)]
    for turns, (low, high) in zip(zip(*points), arm.limits()):
        if len(set(turns)) == 1 or all(low <= angle <= high for angle in turns):
            continue
        arm.angles.brake(now)
        arm.remarks.append("stopped: the motion leads beyond the new limits")
        return
