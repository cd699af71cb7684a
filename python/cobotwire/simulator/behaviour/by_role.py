"""What the arm does for commands by their roles, in any edition.

So editions may name commands and arguments in their own way, and have any number of joints. Where
the registry has a behaviour for the command's name and fields, that one is used.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cobotwire.protocol.fields import Field
from cobotwire.protocol.roles import ANGLES, as_reached_query, picked, row_index
from cobotwire.protocol.table import Command, Role, Table
from cobotwire.simulator.behaviour.registry import Unanswerable
from cobotwire.simulator.coordinates import places_of, pose_with
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import go_to_angle, go_to_angles, go_to_coords

# The speed of a motion whose command has no speed, in percent.
USUAL_SPEED = 50

Fields = Mapping[str, Any]
Perform = Callable[[Table, ArmState, float, Command, Fields], Any]


def perform_role(
    table: Table, arm: ArmState, now: float, command: Command, fields: Fields
) -> dict[str, Any]:
    """Perform a command whose role is in ``PERFORMED``; return the fields that its reply has.

    Raises:
        Unanswerable: the arm does not know what the reply reports.
    """
    value = PERFORMED[command.role](table, arm, now, command, fields)
    return {command.reply[0].fields[-1].name: value} if command.requires_reply else {}


def _move_joints(table: Table, arm: ArmState, now: float, command: Command, fields: Fields) -> None:
    go_to_angles(arm, tuple(fields[_row(command).name]), _speed(command, fields), now)


def _move_joint(table: Table, arm: ArmState, now: float, command: Command, fields: Fields) -> None:
    picker, target = picked(command.request[0])
    names = [field.name for field in command.request[0].fields]
    go_to_angle(arm, fields[names[picker]], fields[names[target]], _speed(command, fields), now)


def _move_end(table: Table, arm: ArmState, now: float, command: Command, fields: Fields) -> None:
    row = _row(command)
    places = places_of(row.cases[0].numbers)
    if places is None:
        arm.remarks.append("rejected: the arm has no inverse kinematics for these coordinates")
        return
    end = pose_with(fields[row.name], places, arm.end(arm.angles.target(now)))
    go_to_coords(arm, end, _speed(command, fields), now)


def _joints(
    table: Table, arm: ArmState, now: float, command: Command, fields: Fields
) -> tuple[float, ...]:
    return arm.reported_angles(arm.angles.position(now))


def _coordinates(
    table: Table, arm: ArmState, now: float, command: Command, fields: Fields
) -> tuple[float, ...]:
    coords = arm.reported_coords(arm.standing(now))
    if coords is None or places_of(command.reply[0].fields[-1].cases[0].numbers) is None:
        raise Unanswerable
    return coords


def _reached(table: Table, arm: ArmState, now: float, command: Command, fields: Fields) -> bool:
    query = as_reached_query(command)
    target, standing, (degrees, millimetres) = fields[query.row], arm.standing(now), arm.near
    kind = fields[query.kind] if query.kind else next(iter(query.kinds.values()))
    if kind == query.kinds.get(ANGLES):
        return all(abs(have - wish) <= degrees for have, wish in zip(standing, target))
    end = arm.end(standing)
    if end is None or len(target) != len(arm.coordinates):
        raise Unanswerable
    way, turn = end.distance(arm.pose_of(target, standing))
    # Each joint rests up to half a tick from the angle that the target requires.
    return way <= millimetres and turn <= degrees + arm.joints * arm.tick_degrees / 2


def _moving(table: Table, arm: ArmState, now: float, command: Command, fields: Fields) -> bool:
    # A braking arm still moves; one that is led by hand does not move by itself.
    return arm.angles.moving(now) and not arm.released


def _stop(table: Table, arm: ArmState, now: float, command: Command, fields: Fields) -> None:
    # End every motion, and a pause; the next motion is obeyed.
    arm.angles.brake(now)
    arm.resume(now)


def _row(command: Command) -> Field:
    return command.request[0].fields[row_index(command.request[0])]


def _speed(command: Command, fields: Fields) -> int:
    """Return the speed of a request in percent: the argument with that unit."""
    for field in command.request[0].fields:
        if not field.many and field.cases[0].numbers[0].unit == "percent":
            return round(float(fields.get(field.name, USUAL_SPEED)))
    return USUAL_SPEED


PERFORMED: dict[Role, Perform] = {
    "joint targets": _move_joints,
    "joint target": _move_joint,
    "coordinate targets": _move_end,
    "joints": _joints,
    "coordinates": _coordinates,
    "reached": _reached,
    "moving": _moving,
    "stop": _stop,
    "powered": lambda table, arm, now, command, fields: arm.powered,
    "paused": lambda table, arm, now, command, fields: arm.paused,
    "error": lambda table, arm, now, command, fields: arm.error,
}
