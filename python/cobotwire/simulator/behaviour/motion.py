"""Motions of the end in a chosen way, and pauses; ``by_role`` has the other motions."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.editions.mycobot280.enums import MovementType, MoveMode
from cobotwire.simulator.behaviour.registry import behaviour
from cobotwire.simulator.coordinates import pose_with
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_coords


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


@behaviour(m.Resume)
def resume(arm: ArmState, now: float, request: m.Resume) -> None:
    """End a pause, and continue."""
    arm.resume(now)


def moves_straight(arm: ArmState) -> bool:
    """Return whether the end moves on a straight line if the command does not choose."""
    return arm.movement_type == MovementType.LINEAR
