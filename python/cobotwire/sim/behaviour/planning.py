"""Motion and kinematics that only newer firmware knows, and where a motion will end."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.motion import LINEAR, told
from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.kinematics import Pose
from cobotwire.sim.state import ArmState
from cobotwire.sim.targets import go_to_angles, go_to_coords, solve

# Below this share a drag plays a point at its speed; the simulated arm plays it at one of its own.
DRAG_SPEED = 50


@does("clear_queue")
def clear_queue(arm: ArmState, now: float) -> None:
    """Forget the targets that wait; no source says more, so what is under way goes on."""
    arm.angles.forget(now)


@does("get_angles_plan")
def get_angles_plan(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the joints will stand."""
    return {"angles": arm.told_angles(arm.angles.target(now))}


@does("get_coords_plan")
def get_coords_plan(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the end will stand, in the base's frame."""
    return told("coords", arm.told_coords(arm.angles.target(now), base=True))


@does("get_angles_coords")
def get_angles_coords(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the joints and the end stand."""
    standing = arm.standing(now)
    return {"angles": arm.told_angles(standing), **told("coords", arm.told_coords(standing))}


@does("angles_to_coords")
def angles_to_coords(arm: ArmState, now: float, angles: tuple[float, ...]) -> dict[str, Any]:
    """Where the end would be, in the frame and for the end type that are set; nothing moves.

    Joints stand on ticks: for the angles that get_angles tells, it is what get_coords tells.
    """
    return told("coords", arm.told_coords(arm.on_ticks(angles)))


@does("solve_inv_kinematics")
def solve_inv_kinematics(
    arm: ArmState, now: float, coords: tuple[float, ...], angles: tuple[float, ...]
) -> dict[str, Any]:
    """The angles for an end, near the given ones; those themselves, and an error, if none do.

    No source says what comes where there is no solution.
    """
    found = solve(arm, Pose.of(coords), angles) if arm.geometry else None
    return {"angles": angles if found is None else found}


@does("jog_increment_coord")
def jog_increment_coord(arm: ArmState, now: float, axis: int, increment: float, speed: int) -> None:
    """Move the end along or about an axis by a step, from where it is on its way to."""
    end = arm.end(arm.angles.target(now))
    target = list(end.coords) if end else [0.0] * 6
    target[axis - 1] += increment
    go_to_coords(arm, target, speed, now, straight=arm.settings.movement_type == LINEAR)


@does("set_encoders_drag")
def set_encoders_drag(
    arm: ArmState, now: float, encoders: tuple[int, ...], speeds: tuple[int, ...]
) -> None:
    """Move all servos, as a recorded point is played."""
    target = tuple(arm.angle_at(joint, tick) for joint, tick in enumerate(encoders))
    go_to_angles(arm, target, DRAG_SPEED if any(speeds) else 0, now)


@does("focus_all_servos")
def focus_all_servos(arm: ArmState, now: float, **always: int) -> None:
    """Hold every joint."""
    arm.enabled = [arm.powered] * arm.joints
