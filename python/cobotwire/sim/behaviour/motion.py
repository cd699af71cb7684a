"""Targets, pausing, and the questions about motion."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import IN_POSITION_ANGLES, IN_POSITION_COORDS, ArmState


@does("set_fresh_mode")
def set_fresh_mode(arm: ArmState, now: float, mode: int) -> None:
    """Queue targets, or let the newest win."""
    arm.fresh_mode = mode


@does("get_angles")
def get_angles(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the joints stand."""
    return {"angles": arm.angles.position(now)}


@does("send_angle")
def send_angle(arm: ArmState, now: float, joint: int, angle: float, speed: int) -> None:
    """Move one joint."""
    target = list(arm.angles.target(now))
    target[joint - 1] = angle
    arm.go_to_angles(tuple(target), speed, now)


@does("send_angles")
def send_angles(arm: ArmState, now: float, angles: tuple[float, ...], speed: int) -> None:
    """Move all joints."""
    arm.go_to_angles(angles, speed, now)


@does("get_coords")
def get_coords(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the end stands."""
    return {"coords": arm.pose.position(now)}


@does("send_coord")
def send_coord(arm: ArmState, now: float, axis: int, coord: float, speed: int) -> None:
    """Move the end along or about one axis."""
    target = list(arm.pose.target(now))
    target[axis - 1] = coord
    arm.go_to_coords(tuple(target), speed, now)


@does("send_coords")
def send_coords(
    arm: ArmState, now: float, coords: tuple[float, ...], speed: int, mode: int = 0
) -> None:
    """Move the end."""
    arm.go_to_coords(coords, speed, now)


@does("pause")
def pause(arm: ArmState, now: float) -> None:
    """Stand still, and keep the way."""
    arm.paused = True
    arm.angles.pause(now)
    arm.pose.pause(now)


@does("is_paused")
def is_paused(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the arm is paused."""
    return {"paused": arm.paused}


@does("resume")
def resume(arm: ArmState, now: float) -> None:
    """Go on; after a stop, obey motion again."""
    arm.paused, arm.stopped = False, False
    arm.angles.resume(now)
    arm.pose.resume(now)


@does("stop")
def stop(arm: ArmState, now: float) -> None:
    """End every motion; none is obeyed until resume."""
    resume(arm, now)
    arm.halt(now)
    arm.stopped = True


@does("is_in_position")
def is_in_position(
    arm: ArmState, now: float, target: tuple[float, ...], kind: int
) -> dict[str, Any]:
    """Whether the joints, or the end, stand at a target."""
    axes, tolerances = (
        (arm.pose, IN_POSITION_COORDS) if kind == 1 else (arm.angles, IN_POSITION_ANGLES)
    )
    ways = (abs(a - b) for a, b in zip(axes.position(now), target))
    return {"reached": all(way <= most for way, most in zip(ways, tolerances))}


@does("is_moving")
def is_moving(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the arm moves right now."""
    moving = arm.angles.moving(now) or arm.pose.moving(now)
    return {"moving": moving and not arm.paused}


@does("get_speed")
def get_speed(arm: ArmState, now: float) -> dict[str, Any]:
    """The speed of commands that carry none."""
    return {"speed": arm.speed}


@does("set_speed")
def set_speed(arm: ArmState, now: float, speed: int) -> None:
    """Set the speed of commands that carry none."""
    arm.speed = speed
