"""Simulate the waist of a robot with two arms, and commands that address several limbs.

Each limb has a state of its own. No source gives the geometry of such a robot, so queries of
coordinates have no reply.
"""

from __future__ import annotations

from typing import Any

from cobotwire.editions.mybuddy import messages as m
from cobotwire.editions.mybuddy.enums import TargetKind
from cobotwire.simulator.behaviour.registry import Behaviours, Unanswerable, family
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_encoders

# In percent; used if a request states a duration, or a speed for each servo, instead of one speed.
USUAL_SPEED = 50

LIMBS = family("mybuddy", Behaviours())


@LIMBS.behaviour(m.SetEncoders)
def set_encoders(arm: ArmState, now: float, request: m.SetEncoders) -> None:
    """Move all servos; they arrive together."""
    if request.speeds is not None:
        speed = USUAL_SPEED if any(request.speeds) else 0
    else:
        assert request.speed is not None, "a request states a speed or speeds"
        speed = request.speed
    go_to_encoders(arm, dict(enumerate(request.encoders)), speed, now)


@LIMBS.behaviour(m.IsWaistInPosition)
def is_waist_in_position(
    arm: ArmState, now: float, request: m.IsWaistInPosition
) -> m.IsWaistInPositionReply:
    """Reply whether the waist has reached the requested angle."""
    if request.kind != TargetKind.ANGLES:
        raise Unanswerable("no source says what the coordinate of a waist is")
    if arm.joints != 1:
        raise Unanswerable("only the waist replies to it")
    return m.IsWaistInPositionReply(
        reached=abs(arm.standing(now)[0] - request.target) <= arm.near[0]
    )


@LIMBS.behaviour(m.IsRobotInPosition)
def is_robot_in_position(arm: ArmState, now: float, request: Any) -> None:
    """Do not reply: no source says which limb replies, and each limb is simulated separately."""
    raise Unanswerable("no source says which limb replies for the whole robot")


def _without_geometry(arm: ArmState, now: float, request: Any) -> None:
    raise Unanswerable


for _query in (m.GetBaseCoords, m.Collision, m.SingleToBaseCoords, m.BaseToSingleCoords):
    LIMBS.behaviour(_query)(_without_geometry)
