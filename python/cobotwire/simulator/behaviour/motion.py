"""Targets, pausing, and the queries about motion."""

from __future__ import annotations

from cobotwire.editions.mycobot.messages import GetSpeed, GetSpeedReply, SetSpeed
from cobotwire.editions.mycobot280.enums import MoveMode, TargetKind
from cobotwire.editions.mycobot280.messages import (
    GetAngles,
    GetAnglesReply,
    GetCoords,
    GetCoordsReply,
    IsInPosition,
    IsInPositionReply,
    IsMoving,
    IsMovingReply,
    IsPaused,
    IsPausedReply,
    Pause,
    Resume,
    SendAngle,
    SendAngles,
    SendCoord,
    SendCoords,
    SetFreshMode,
    Stop,
)
from cobotwire.simulator.behaviour.registry import behaviour, row
from cobotwire.simulator.kinematics import DEGREES_PER_TICK, Pose
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_angle, go_to_angles, go_to_coords

# How near to a target counts as reached, according to the notes on kinematics.
DEGREES, MILLIMETRES = 0.1, 5.0


@behaviour(SetFreshMode)
def set_fresh_mode(arm: ArmState, now: float, request: SetFreshMode) -> None:
    """Queue targets, or let the newest replace the others."""
    arm.fresh_mode = request.mode


@behaviour(GetAngles)
def get_angles(arm: ArmState, now: float, request: GetAngles) -> GetAnglesReply:
    """Reply with the angles of the joints."""
    return GetAnglesReply(angles=row(arm.reported_angles(arm.angles.position(now))))


@behaviour(SendAngle)
def send_angle(arm: ArmState, now: float, request: SendAngle) -> None:
    """Move one joint."""
    go_to_angle(arm, request.joint, request.angle, request.speed, now)


@behaviour(SendAngles)
def send_angles(arm: ArmState, now: float, request: SendAngles) -> None:
    """Move all joints."""
    go_to_angles(arm, tuple(request.angles), request.speed, now)


@behaviour(GetCoords)
def get_coords(arm: ArmState, now: float, request: GetCoords) -> GetCoordsReply | None:
    """Reply with the end's coordinates, in the frame and for the end type that are set."""
    coords = arm.reported_coords(arm.standing(now))
    return None if coords is None else GetCoordsReply(coords=row(coords))


@behaviour(SendCoord)
def send_coord(arm: ArmState, now: float, request: SendCoord) -> None:
    """Move the end along or about one axis; the other coordinates are those of its target."""
    end = arm.end(arm.angles.target(now))
    target = list(end.coords) if end else [0.0] * 6
    target[request.axis - 1] = request.coord
    go_to_coords(arm, target, request.speed, now, straight=moves_straight(arm))


@behaviour(SendCoords)
def send_coords(arm: ArmState, now: float, request: SendCoords) -> None:
    """Move the end; without a mode, the movement type decides how."""
    straight = moves_straight(arm) if request.mode is None else request.mode == MoveMode.LINEAR
    go_to_coords(arm, request.coords, request.speed, now, straight=straight)


@behaviour(Pause)
def pause(arm: ArmState, now: float, request: Pause) -> None:
    """Stop, and keep the targets."""
    arm.paused = True
    arm.angles.pause(now)


@behaviour(IsPaused)
def is_paused(arm: ArmState, now: float, request: IsPaused) -> IsPausedReply:
    """Reply whether the arm is paused."""
    return IsPausedReply(paused=arm.paused)


@behaviour(Resume)
def resume(arm: ArmState, now: float, request: Resume) -> None:
    """Continue; after a stop, obey motion again."""
    arm.resume(now)


@behaviour(Stop)
def stop(arm: ArmState, now: float, request: Stop) -> None:
    """End every motion; the arm ignores later ones until resume."""
    arm.angles.brake(now)
    arm.resume(now)
    arm.stopped = True


@behaviour(IsInPosition)
def is_in_position(arm: ArmState, now: float, request: IsInPosition) -> IsInPositionReply:
    """Reply whether the joints, or the end, are at a target."""
    standing = arm.standing(now)
    if request.kind != TargetKind.COORDS:
        near = (abs(a - b) <= DEGREES for a, b in zip(standing, request.target))
        return IsInPositionReply(reached=all(near))
    end = arm.end(standing)
    if end is None:
        return IsInPositionReply(reached=False)
    way, turn = end.distance(Pose.of(request.target))
    # Each joint rests up to half a tick from the angle that the target requires.
    reached = way <= MILLIMETRES and turn <= DEGREES + arm.joints * DEGREES_PER_TICK / 2
    return IsInPositionReply(reached=reached)


@behaviour(IsMoving)
def is_moving(arm: ArmState, now: float, request: IsMoving) -> IsMovingReply:
    """Reply whether the arm moves; while it brakes, it does."""
    return IsMovingReply(moving=arm.angles.moving(now))


@behaviour(GetSpeed)
def get_speed(arm: ArmState, now: float, request: GetSpeed) -> GetSpeedReply:
    """Reply with the speed of commands that have no speed of their own."""
    return GetSpeedReply(speed=arm.speed)


@behaviour(SetSpeed)
def set_speed(arm: ArmState, now: float, request: SetSpeed) -> None:
    """Set the speed of commands that have no speed of their own."""
    arm.speed = request.speed


def moves_straight(arm: ArmState) -> bool:
    """Return whether the end moves on a straight line if the command does not choose."""
    return arm.settings.movement_type == MoveMode.LINEAR
