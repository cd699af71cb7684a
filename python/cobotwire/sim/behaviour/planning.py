"""Motion that only newer firmware knows, and where a motion will end."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.jog import jog_coord
from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import ArmState, tick_to_angle

# Below this share a drag plays a point at its speed; the simulated arm plays it at one of its own.
DRAG_SPEED = 50


@does("clear_queue")
def clear_queue(arm: ArmState, now: float) -> None:
    """Forget every target."""
    arm.halt(now)


@does("get_angles_plan")
def get_angles_plan(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the joints will stand."""
    return {"angles": arm.angles.target(now)}


@does("get_coords_plan")
def get_coords_plan(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the end will stand."""
    return {"coords": arm.pose.target(now)}


@does("get_angles_coords")
def get_angles_coords(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the joints and the end stand."""
    return {"angles": arm.angles.position(now), "coords": arm.pose.position(now)}


@does("jog_rpy")
def jog_rpy(arm: ArmState, now: float, axis: int, direction: int, speed: int) -> None:
    """Turn the end about roll, pitch or yaw until it is stopped."""
    jog_coord(arm, now, axis + 3, direction, speed)


@does("jog_increment_coord")
def jog_increment_coord(arm: ArmState, now: float, axis: int, increment: float, speed: int) -> None:
    """Move the end along or about an axis by a step."""
    target = list(arm.pose.target(now))
    target[axis - 1] += increment
    arm.go_to_coords(tuple(target), speed, now)


@does("set_encoders_drag")
def set_encoders_drag(
    arm: ArmState, now: float, encoders: tuple[int, ...], speeds: tuple[int, ...]
) -> None:
    """Move all servos, as a recorded point is played."""
    target = tuple(tick_to_angle(joint, tick) for joint, tick in enumerate(encoders))
    arm.go_to_angles(target, DRAG_SPEED if any(speeds) else 0, now)


@does("focus_all_servos")
def focus_all_servos(arm: ArmState, now: float, **always: int) -> None:
    """Hold every joint."""
    arm.enabled = [arm.powered] * arm.joints
