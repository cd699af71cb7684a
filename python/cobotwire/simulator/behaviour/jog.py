"""Jogging: motion in a direction until it is stopped, or by a step."""

from __future__ import annotations

from cobotwire.editions.mycobot.messages import JogAbsolute, JogStop
from cobotwire.editions.mycobot280 import messages as m
from cobotwire.simulator.behaviour.registry import behaviour
from cobotwire.simulator.kinematics import Pose
from cobotwire.simulator.kinematics.pose import turned_about
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import (
    STEP_DEGREES,
    STEP_MILLIMETRES,
    go_to_angle,
    go_to_angles,
    jog,
    reject,
)

FORWARD = 1


@behaviour(m.JogAngle)
def jog_angle(arm: ArmState, now: float, request: m.JogAngle) -> None:
    """Turn a joint until its limit, or until it is stopped. The other joints do not move."""
    joint = request.joint
    low, high = arm.limits()[joint - 1]
    target = list(arm.angles.stop_at(now))
    forward = request.direction == FORWARD
    inside = target[joint - 1] < high if forward else low < target[joint - 1]
    if low > high or not inside:
        code = arm.error_codes.joint_limits[joint - 1]
        reject(arm, f"rejected: joint {joint} is at its limit", code)
        return
    target[joint - 1] = high if forward else low
    go_to_angles(arm, tuple(target), request.speed, now, queue=False)


@behaviour(JogAbsolute)
def jog_absolute(arm: ArmState, now: float, request: JogAbsolute) -> None:
    """Turn a joint to an angle."""
    go_to_angle(arm, request.joint, request.angle, request.speed, now)


@behaviour(m.JogCoord)
def jog_coord(arm: ArmState, now: float, request: m.JogCoord) -> None:
    """Move the end along an axis, or change one of its angles, until it is stopped."""
    place = arm.coordinates[request.axis - 1]
    step = STEP_MILLIMETRES if place < 3 else STEP_DEGREES

    def way(here: Pose, far: float) -> Pose:
        coords = list(here.coords)
        coords[place] += far
        return Pose.of(coords)

    jog(arm, way, step if request.direction == FORWARD else -step, request.speed, now)


@behaviour(m.JogRpy)
def jog_rpy(arm: ArmState, now: float, request: m.JogRpy) -> None:
    """Turn the end on the spot about a fixed axis, until it is stopped."""

    def way(here: Pose, far: float) -> Pose:
        return turned_about(request.axis - 1, far).then(here)._replace(origin=here.origin)

    step = STEP_DEGREES if request.direction == FORWARD else -STEP_DEGREES
    jog(arm, way, step, request.speed, now)


@behaviour(m.JogIncrement)
def jog_increment(arm: ArmState, now: float, request: m.JogIncrement) -> None:
    """Turn a joint by a step."""
    angle = arm.angles.target(now)[request.joint - 1] + request.increment
    go_to_angle(arm, request.joint, angle, request.speed, now)


@behaviour(JogStop)
def jog_stop(arm: ArmState, now: float, request: JogStop) -> None:
    """End the motion; the next one is obeyed."""
    arm.angles.brake(now)
