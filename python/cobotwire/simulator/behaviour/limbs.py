"""Robots with two arms and a waist: single joints, the waist, and coordinates in the base.

Each limb has a state of its own. No source gives the geometry of such a robot, so queries of
coordinates have no reply, and motions to coordinates are rejected.
"""

from __future__ import annotations

from typing import Any

from cobotwire.editions.mybuddy import messages as m
from cobotwire.editions.mybuddy.enums import TargetKind
from cobotwire.simulator.behaviour.registry import Behaviours, Unanswerable, family
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_angles, go_to_encoders

# The speed of a motion within a time, and of one with a speed for each servo, in percent.
USUAL_SPEED = 50
USUAL_PLAN = 50

LIMBS = family("mybuddy", Behaviours())


@LIMBS.behaviour(m.GetAngle)
def get_angle(arm: ArmState, now: float, request: m.GetAngle) -> m.GetAngleReply:
    """Reply with the angle of a joint."""
    if request.joint > arm.joints:
        raise Unanswerable("no source says what is reported for the gripper")
    angles = arm.reported_angles(arm.angles.position(now))
    return m.GetAngleReply(angle=angles[request.joint - 1])


@LIMBS.behaviour(m.SendAnglesAuto)
def send_angles_auto(arm: ArmState, now: float, request: m.SendAnglesAuto) -> None:
    """Move all joints."""
    go_to_angles(arm, tuple(request.angles), USUAL_SPEED, now)


@LIMBS.behaviour(m.SetEncoders)
def set_encoders(arm: ArmState, now: float, request: m.SetEncoders) -> None:
    """Move all servos; they arrive together."""
    if request.speeds is not None:
        speed = USUAL_SPEED if any(request.speeds) else 0
    else:
        assert request.speed is not None, "a request has one of both"
        speed = request.speed
    go_to_encoders(arm, dict(enumerate(request.encoders)), speed, now)


@LIMBS.behaviour(m.IsWaistInPosition)
def is_waist_in_position(
    arm: ArmState, now: float, request: m.IsWaistInPosition
) -> m.IsWaistInPositionReply:
    """Reply whether the waist is at an angle."""
    if request.kind != TargetKind.ANGLES:
        raise Unanswerable("no source says what the coordinate of a waist is")
    if arm.joints != 1:
        raise Unanswerable("the request is for the waist")
    return m.IsWaistInPositionReply(
        reached=abs(arm.standing(now)[0] - request.target) <= arm.near[0]
    )


@LIMBS.behaviour(m.IsRobotInPosition)
def is_robot_in_position(arm: ArmState, now: float, request: Any) -> None:
    """Do not reply: no source says which limb does, and none knows the others."""
    raise Unanswerable("no source says which limb replies for the whole robot")


def _without_geometry(arm: ArmState, now: float, request: Any) -> None:
    raise Unanswerable


def _rejected(arm: ArmState, now: float, request: Any) -> None:
    arm.remarks.append("rejected: the geometry of this robot is not known")


for _query in (
    *(m.GetCoord, m.GetBaseCoord, m.GetBaseCoords, m.Collision),
    *(m.SingleToBaseCoords, m.BaseToSingleCoords),
):
    LIMBS.behaviour(_query)(_without_geometry)
for _motion in (m.WriteBaseCoord, m.WriteBaseCoords, m.JogIncCoord):
    LIMBS.behaviour(_motion)(_rejected)


@LIMBS.behaviour(m.SetPlanSpeed)
def set_plan_speed(arm: ArmState, now: float, request: m.SetPlanSpeed) -> None:
    """Set both speeds of planned motions: no source says which of them is set."""
    arm.kept["plan speed"] = request.speed


@LIMBS.behaviour(m.GetPlanSpeed)
def get_plan_speed(arm: ArmState, now: float, request: m.GetPlanSpeed) -> m.GetPlanSpeedReply:
    """Reply with the speeds of planned motions."""
    speed = arm.kept.get("plan speed", USUAL_PLAN)
    return m.GetPlanSpeedReply(linear=speed, angular=speed)


@LIMBS.behaviour(m.SetPlanAcceleration)
def set_plan_acceleration(arm: ArmState, now: float, request: m.SetPlanAcceleration) -> None:
    """Set both accelerations of planned motions: no source says which of them is set."""
    arm.kept["plan acceleration"] = request.acceleration


@LIMBS.behaviour(m.GetPlanAcceleration)
def get_plan_acceleration(
    arm: ArmState, now: float, request: m.GetPlanAcceleration
) -> m.GetPlanAccelerationReply:
    """Reply with the accelerations of planned motions."""
    acceleration = arm.kept.get("plan acceleration", USUAL_PLAN)
    return m.GetPlanAccelerationReply(linear=acceleration, angular=acceleration)
