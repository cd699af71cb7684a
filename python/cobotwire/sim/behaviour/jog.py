"""Jogging: motion in a direction until it is stopped, or by a step."""

from __future__ import annotations

from cobotwire.sim.behaviour.motion import send_angle
from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.kinematics import Pose
from cobotwire.sim.kinematics.pose import turned_about
from cobotwire.sim.state import ArmState
from cobotwire.sim.targets import STEP_DEGREES, STEP_MILLIMETRES, go_to_angles, jog, refuse

FORWARD = 1


@does("jog_angle")
def jog_angle(arm: ArmState, now: float, joint: int, direction: int, speed: int) -> None:
    """Turn a joint until its limit, or until it is stopped. The other joints stand."""
    low, high = arm.limits()[joint - 1]
    target = list(arm.angles.stop_at(now))
    inside = target[joint - 1] < high if direction == FORWARD else low < target[joint - 1]
    if low > high or not inside:
        refuse(arm, f"refused: joint {joint} is at its limit", joint)
        return
    target[joint - 1] = high if direction == FORWARD else low
    go_to_angles(arm, tuple(target), speed, now, queue=False)


@does("jog_absolute")
def jog_absolute(arm: ArmState, now: float, joint: int, angle: float, speed: int) -> None:
    """Turn a joint to an angle."""
    send_angle(arm, now, joint, angle, speed)


@does("jog_coord")
def jog_coord(arm: ArmState, now: float, axis: int, direction: int, speed: int) -> None:
    """Move the end along an axis, or change one of its angles, until it is stopped."""
    step = STEP_MILLIMETRES if axis <= 3 else STEP_DEGREES

    def way(here: Pose, far: float) -> Pose:
        coords = list(here.coords)
        coords[axis - 1] += far
        return Pose.of(coords)

    jog(arm, way, step if direction == FORWARD else -step, speed, now)


@does("jog_rpy")
def jog_rpy(arm: ArmState, now: float, axis: int, direction: int, speed: int) -> None:
    """Turn the end about a fixed axis, where it stands, until it is stopped."""

    def way(here: Pose, far: float) -> Pose:
        return turned_about(axis - 1, far).then(here)._replace(origin=here.origin)

    jog(arm, way, STEP_DEGREES if direction == FORWARD else -STEP_DEGREES, speed, now)


@does("jog_increment")
def jog_increment(arm: ArmState, now: float, joint: int, increment: float, speed: int) -> None:
    """Turn a joint by a step."""
    send_angle(arm, now, joint, arm.angles.target(now)[joint - 1] + increment, speed)


@does("jog_stop")
def jog_stop(arm: ArmState, now: float) -> None:
    """End the motion; the next one is obeyed."""
    arm.angles.brake(now)
