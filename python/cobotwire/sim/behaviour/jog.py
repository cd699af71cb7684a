"""Jogging: motion in a direction until it is stopped, or by a step."""

from __future__ import annotations

from cobotwire.sim.behaviour.motion import send_angle
from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import ArmState

# Further than the end of any 280 can reach, and inside what the wire can say.
FAR_MILLIMETRES = 500.0
FAR_DEGREES = 180.0


@does("jog_angle")
def jog_angle(arm: ArmState, now: float, joint: int, direction: int, speed: int) -> None:
    """Turn a joint until its limit, or until it is stopped."""
    limit = arm.maximum if direction == 1 else arm.minimum
    arm.halt(now)
    send_angle(arm, now, joint, limit[joint - 1], speed)


@does("jog_absolute")
def jog_absolute(arm: ArmState, now: float, joint: int, angle: float, speed: int) -> None:
    """Turn a joint to an angle."""
    send_angle(arm, now, joint, angle, speed)


@does("jog_coord")
def jog_coord(arm: ArmState, now: float, axis: int, direction: int, speed: int) -> None:
    """Move the end along or about an axis until it is stopped."""
    far = FAR_MILLIMETRES if axis <= 3 else FAR_DEGREES
    arm.halt(now)
    target = list(arm.pose.position(now))
    target[axis - 1] = far if direction == 1 else -far
    arm.go_to_coords(tuple(target), speed, now)


@does("jog_increment")
def jog_increment(arm: ArmState, now: float, joint: int, increment: float, speed: int) -> None:
    """Turn a joint by a step."""
    send_angle(arm, now, joint, arm.angles.target(now)[joint - 1] + increment, speed)


@does("jog_stop")
def jog_stop(arm: ArmState, now: float) -> None:
    """End the motion; the next one is obeyed."""
    arm.halt(now)
