"""Targets, pausing, and the queries about motion."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.editions.mycobot280.enums import MovementType, MoveMode, TargetKind
from cobotwire.simulator.behaviour.registry import Unanswerable, behaviour, known, query, row
from cobotwire.simulator.coordinates import pose_with
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_angle, go_to_angles, go_to_coords

query(m.GetAngles, lambda arm, now, request: row(arm.reported_angles(arm.angles.position(now))))


@behaviour(m.SendAngle)
def send_angle(arm: ArmState, now: float, request: m.SendAngle) -> None:
    """Move one joint."""
    go_to_angle(arm, request.joint, request.angle, request.speed, now)


@behaviour(m.SendAngles)
def send_angles(arm: ArmState, now: float, request: m.SendAngles) -> None:
    """Move all joints."""
    go_to_angles(arm, tuple(request.angles), request.speed, now)


# In the frame and for the end type that are set.
query(m.GetCoords, lambda arm, now, request: row(known(arm.reported_coords(arm.standing(now)))))


@behaviour(m.SendCoord)
def send_coord(arm: ArmState, now: float, request: m.SendCoord) -> None:
    """Move the end along or about one axis; the other coordinates are those of its target."""
    end, place = arm.end(arm.angles.target(now)), arm.coordinates[request.axis - 1]
    target = pose_with((request.coord,), (place,), end)
    go_to_coords(arm, target, request.speed, now, straight=moves_straight(arm))


@behaviour(m.SendCoords)
def send_coords(arm: ArmState, now: float, request: m.SendCoords) -> None:
    """Move the end; without a mode, the movement type decides how."""
    straight = moves_straight(arm) if request.mode is None else request.mode == MoveMode.LINEAR
    go_to_coords(arm, request.coords, request.speed, now, straight=straight)


@behaviour(m.Pause)
def pause(arm: ArmState, now: float, request: m.Pause) -> None:
    """Stop, and keep the targets."""
    arm.paused = True
    arm.angles.pause(now)


query(m.IsPaused, lambda arm, now, request: arm.paused)


@behaviour(m.Resume)
def resume(arm: ArmState, now: float, request: m.Resume) -> None:
    """End a pause, and continue."""
    arm.resume(now)


@behaviour(m.Stop)
def stop(arm: ArmState, now: float, request: m.Stop) -> None:
    """End every motion, and a pause; the next motion is obeyed."""
    arm.angles.brake(now)
    arm.resume(now)


@behaviour(m.IsInPosition)
def is_in_position(arm: ArmState, now: float, request: m.IsInPosition) -> m.IsInPositionReply:
    """Reply whether the joints, or the end, are at a target."""
    standing, (degrees, millimetres) = arm.standing(now), arm.near
    if request.kind != TargetKind.COORDS:
        near = (abs(a - b) <= degrees for a, b in zip(standing, request.target))
        return m.IsInPositionReply(reached=all(near))
    end = arm.end(standing)
    if end is None:
        raise Unanswerable
    way, turn = end.distance(arm.pose_of(request.target, standing))
    # Each joint rests up to half a tick from the angle that the target requires.
    reached = way <= millimetres and turn <= degrees + arm.joints * arm.tick_degrees / 2
    return m.IsInPositionReply(reached=reached)


# A braking arm still moves; one that is led by hand does not move by itself.
query(m.IsMoving, lambda arm, now, request: arm.angles.moving(now) and not arm.released)


def moves_straight(arm: ArmState) -> bool:
    """Return whether the end moves on a straight line if the command does not choose."""
    return arm.movement_type == MovementType.LINEAR
