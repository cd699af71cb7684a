"""Targets, pausing, and the questions about motion."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.kinematics import DEGREES_A_TICK, Pose
from cobotwire.sim.state import ArmState
from cobotwire.sim.targets import go_to_angles, go_to_coords

# How far from a target still counts as there, by the notes on kinematics.
DEGREES, MILLIMETRES = 0.1, 5.0
LINEAR = 1
COORDS = 1


@does("set_fresh_mode")
def set_fresh_mode(arm: ArmState, now: float, mode: int) -> None:
    """Queue targets, or let the newest win."""
    arm.fresh_mode = mode


@does("get_angles")
def get_angles(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the joints stand."""
    return {"angles": arm.told_angles(arm.angles.position(now))}


@does("send_angle")
def send_angle(arm: ArmState, now: float, joint: int, angle: float, speed: int) -> None:
    """Move one joint."""
    target = list(arm.angles.target(now))
    target[joint - 1] = angle
    go_to_angles(arm, tuple(target), speed, now)


@does("send_angles")
def send_angles(arm: ArmState, now: float, angles: tuple[float, ...], speed: int) -> None:
    """Move all joints."""
    go_to_angles(arm, angles, speed, now)


@does("get_coords")
def get_coords(arm: ArmState, now: float) -> dict[str, Any]:
    """Where the end stands, in the frame and for the end type that are set."""
    return told("coords", arm.told_coords(arm.standing(now)))


@does("send_coord")
def send_coord(arm: ArmState, now: float, axis: int, coord: float, speed: int) -> None:
    """Move the end along or about one axis; the other coordinates are those it is on its way to."""
    end = arm.end(arm.angles.target(now))
    target = list(end.coords) if end else [0.0] * 6
    target[axis - 1] = coord
    go_to_coords(arm, target, speed, now, straight=arm.settings.movement_type == LINEAR)


@does("send_coords")
def send_coords(
    arm: ArmState, now: float, coords: tuple[float, ...], speed: int, mode: int | None = None
) -> None:
    """Move the end; without a mode in the way that is set."""
    way = arm.settings.movement_type if mode is None else mode
    go_to_coords(arm, coords, speed, now, straight=way == LINEAR)


@does("pause")
def pause(arm: ArmState, now: float) -> None:
    """Stand still, and keep the way."""
    arm.paused = True
    arm.angles.pause(now)


@does("is_paused")
def is_paused(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the arm is paused."""
    return {"paused": arm.paused}


@does("resume")
def resume(arm: ArmState, now: float) -> None:
    """Go on; after a stop, obey motion again."""
    arm.paused, arm.stopped = False, False
    arm.angles.resume(now)


@does("stop")
def stop(arm: ArmState, now: float) -> None:
    """End every motion; none is obeyed until resume."""
    arm.angles.brake(now)
    resume(arm, now)
    arm.stopped = True


@does("is_in_position")
def is_in_position(
    arm: ArmState, now: float, target: tuple[float, ...], kind: int
) -> dict[str, Any]:
    """Whether the joints, or the end, stand at a target."""
    there = arm.standing(now)
    if kind != COORDS:
        return {"reached": all(abs(a - b) <= DEGREES for a, b in zip(there, target))}
    end = arm.end(there)
    if end is None:
        return {"reached": False}
    way, turn = end.distance(Pose.of(target))
    # Each joint stands up to half a tick beside the angle that the target asked for.
    return {"reached": way <= MILLIMETRES and turn <= DEGREES + arm.joints * DEGREES_A_TICK / 2}


@does("is_moving")
def is_moving(arm: ArmState, now: float) -> dict[str, Any]:
    """Whether the arm moves right now; while it brakes it does."""
    return {"moving": arm.angles.moving(now)}


@does("get_speed")
def get_speed(arm: ArmState, now: float) -> dict[str, Any]:
    """The speed of commands that carry none."""
    return {"speed": arm.speed}


@does("set_speed")
def set_speed(arm: ArmState, now: float, speed: int) -> None:
    """Set the speed of commands that carry none."""
    arm.speed = speed


def told(name: str, value: tuple[float, ...] | None) -> dict[str, Any]:
    """A field of a reply; without a value the arm answers what is legal, for it knows no better."""
    return {} if value is None else {name: value}
