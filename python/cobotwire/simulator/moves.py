"""Motions, as the effect of a command states them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from cobotwire.kinematics import Pose
from cobotwire.kinematics.coordinates import indices_of, pose_with
from cobotwire.kinematics.pose import turned_about
from cobotwire.kinematics.straight import STEP_DEGREES, STEP_MILLIMETRES
from cobotwire.protocol.effects import Moves
from cobotwire.protocol.fields import Field, named_fields
from cobotwire.protocol.table import Command
from cobotwire.simulator.built_in import unit_of
from cobotwire.simulator.replies import Unanswerable
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import (
    go_to_angle,
    go_to_angles,
    go_to_coords,
    go_to_encoders,
    jog,
    move_gripper,
    reject,
)

# The speed of a motion if its command has no speed, in percent.
USUAL_SPEED = 50
FORWARD, LINEAR = 1, "LINEAR"

Fields = Mapping[str, Any]


def move(arm: ArmState, now: float, command: Command, effect: Moves, fields: Fields) -> None:
    """Begin the requested motion; if the arm rejects it, its state does not change.

    Args:
        arm: the arm.
        now: the time.
        command: the command.
        effect: what the command moves.
        fields: the arguments.
    """
    speed = _speed(arm, effect, fields)
    if effect.part == "gripper":
        move_gripper(arm, float(_value(effect.to, fields)), speed, now)
    elif effect.part == "end":
        _move_end(arm, now, command, effect, fields, speed)
    elif effect.part == "joints":
        _move_joints(arm, now, command, effect, fields, speed)
    else:
        _move_joint(arm, now, command, effect, fields, speed)


def _speed(arm: ArmState, effect: Moves, fields: Fields) -> int:
    given = fields.get(effect.speed)
    if given is None:
        # The arm also moves if no speed has been set yet.
        usual = arm.kept.get("speed")
        return round(usual) if isinstance(usual, int | float) and usual else USUAL_SPEED
    if isinstance(given, tuple | list):
        # A speed for each servo: the arm uses its usual speed for all, or 0 if all are 0.
        return USUAL_SPEED if any(given) else 0
    return round(float(given))


def _value(target: str | float | None, fields: Fields) -> Any:
    return fields[target] if isinstance(target, str) else target


def _argument(command: Command, name: str | float | None) -> Field | None:
    found = named_fields(command.request).get(str(name), ())
    return found[0] if found else None


def _degrees(field: Field | None, value: float) -> float:
    return math.degrees(value) if field is not None and unit_of(field) == "radian" else value


def _move_joints(
    arm: ArmState, now: float, command: Command, effect: Moves, fields: Fields, speed: int
) -> None:
    field, target = _argument(command, effect.to), _value(effect.to, fields)
    if field is None or not field.many:
        go_to_angles(arm, (float(target),) * arm.joints, speed, now)
    elif unit_of(field) == "tick":
        go_to_encoders(arm, dict(enumerate(target)), speed, now)
    else:
        go_to_angles(arm, tuple(_degrees(field, angle) for angle in target), speed, now)


def _move_joint(
    arm: ArmState, now: float, command: Command, effect: Moves, fields: Fields, speed: int
) -> None:
    joint = fields[effect.at[0]]
    name = effect.by or effect.to
    field = _argument(command, name)
    ticks = field is not None and unit_of(field) == "tick"
    # Encoders count the gripper's servo as the last one.
    if not 0 < joint <= arm.joints + ticks:
        raise Unanswerable(f"the arm has no joint {joint}")
    if effect.until:
        _jog_joint(arm, now, joint, speed, forward=fields[effect.direction] == FORWARD)
        return
    value = _value(name, fields)
    if ticks:
        _move_servo(arm, now, joint, value, speed)
    elif effect.by:
        angle = arm.angles.target(now)[joint - 1] + _degrees(field, value)
        go_to_angle(arm, joint, angle, speed, now)
    else:
        go_to_angle(arm, joint, _degrees(field, value), speed, now)


def _move_servo(arm: ArmState, now: float, joint: int, encoder: int, speed: int) -> None:
    """Move one servo to a reading of its encoder.

    The servo after the last joint is the gripper's.
    """
    if joint <= arm.joints:
        go_to_encoders(arm, {joint - 1: encoder}, speed, now)
    elif 0 <= arm.opening_at(encoder) <= 100:
        move_gripper(arm, arm.opening_at(encoder), speed, now)
    else:
        low, high = sorted((arm.gripper_facts.closed, arm.gripper_facts.open))
        arm.remarks.append(f"rejected: the gripper's encoder goes from {low} to {high}")


def _jog_joint(arm: ArmState, now: float, joint: int, speed: int, *, forward: bool) -> None:
    """Turn a joint until its limit, or until it is stopped. The other joints do not move."""
    low, high = arm.limits()[joint - 1]
    target = list(arm.angles.stop_at(now))
    inside = target[joint - 1] < high if forward else low < target[joint - 1]
    if low > high or not inside:
        code = arm.error_codes.joint_limits[joint - 1]
        reject(arm, f"rejected: joint {joint} is at its limit", code)
        return
    target[joint - 1] = high if forward else low
    go_to_angles(arm, tuple(target), speed, now, queue=False)


def _move_end(
    arm: ArmState, now: float, command: Command, effect: Moves, fields: Fields, speed: int
) -> None:
    if effect.until:
        forward = fields[effect.direction] == FORWARD
        _jog_end(arm, now, effect, fields[effect.about], speed, forward=forward)
        return
    end = arm.end(arm.angles.target(now))
    if effect.about:
        place = _axis(arm, fields[effect.about])
        value = _value(effect.by or effect.to, fields)
        if effect.by:
            value += end.coords[place] if end else 0.0
        target = pose_with((value,), (place,), end)
        go_to_coords(arm, target, speed, now, straight=_is_straight(arm, command, fields))
        return
    field = _argument(command, effect.to)
    assert field is not None, "the generator checks that the argument exists"
    indices = indices_of(field.cases[0].numbers)
    if indices is None:
        arm.remarks.append("rejected: the arm has no inverse kinematics for these coordinates")
        return
    row, straight = fields[field.name], _is_straight(arm, command, fields)
    # A full set of coordinates needs nothing of the present pose, which is rounded. So reported
    # coordinates that are sent back lead to the same place.
    target = row if indices == arm.coordinates else pose_with(row, indices, end)
    go_to_coords(arm, target, speed, now, straight=straight)


def _axis(arm: ArmState, number: int) -> int:
    """Return which of x, y, z, rx, ry and rz the number of an axis stands for."""
    if not 0 < number <= len(arm.coordinates):
        raise Unanswerable(f"the end has no axis {number}")
    return arm.coordinates[number - 1]


def _is_straight(arm: ArmState, command: Command, fields: Fields) -> bool:
    """Return whether the arm moves on a straight line: the argument or the setting chooses."""
    for name, found in named_fields(command.request).items():
        labels = dict(zip(found[0].labels, found[0].choices))
        if LINEAR in labels and fields.get(name) is not None:
            return bool(fields[name] == labels[LINEAR])
    return arm.moves_straight


def _jog_end(
    arm: ArmState, now: float, effect: Moves, axis: int, speed: int, *, forward: bool
) -> None:
    """Move the end along or about an axis until it is stopped, or cannot reach further."""
    if effect.keeps:

        def way(here: Pose, far: float) -> Pose:
            return turned_about(axis - 1, far).then(here)._replace(origin=here.origin)

        step = STEP_DEGREES
    else:
        place = _axis(arm, axis)
        step = STEP_MILLIMETRES if place < 3 else STEP_DEGREES

        def way(here: Pose, far: float) -> Pose:
            coords = list(here.coords)
            coords[place] += far
            return Pose.of(coords)

    jog(arm, way, step if forward else -step, speed, now)
