"""The state that every arm has: what it reports, and what happens when a command sets it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from cobotwire.protocol.fields import Field
from cobotwire.protocol.roles import ANGLES, as_reached_query
from cobotwire.protocol.table import Command
from cobotwire.simulator.coordinates import places_of
from cobotwire.simulator.replies import Unanswerable
from cobotwire.simulator.state import ArmState

# Turns a minute of one degree a second.
TURNS_A_MINUTE = 60 / 360

Read = Callable[[ArmState, float, Command, Field, "int | None", Mapping[str, Any]], Any]
Write = Callable[[ArmState, float, Any, "int | None"], None]


def unit_of(field: Field) -> str:
    """Return the unit of a field's first number."""
    return field.cases[0].numbers[0].unit


def _angles(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> Any:
    if unit_of(field) == "tick":
        if joint is not None:
            return arm.encoder(joint - 1, now)
        return tuple(arm.encoder(each, now) for each in range(arm.joints))
    return _one(_in_unit(field, arm.reported_angles(arm.angles.position(now))), joint)


def _planned_angles(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> Any:
    return _one(_in_unit(field, arm.reported_angles(arm.angles.target(now))), joint)


def _in_unit(field: Field, degrees: Iterable[float]) -> tuple[float, ...]:
    radians = unit_of(field) == "radian"
    return tuple(map(math.radians, degrees)) if radians else tuple(degrees)


def _one(row: tuple[Any, ...], joint: int | None) -> Any:
    """Return the value of a joint, counted from 1; without a joint, the row."""
    if joint is None:
        return row
    if joint > len(row):
        raise Unanswerable(f"no source says what is reported for joint {joint}")
    return row[joint - 1]


def _coords(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> Any:
    coords = _answered(arm.reported_coords(arm.standing(now)), field, joint)
    return _one(coords, joint)


def _base_coords(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> Any:
    return _answered(arm.reported_coords(arm.standing(now), base=True), field)


def _planned_coords(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> Any:
    return _answered(arm.reported_coords(arm.angles.target(now), base=True), field)


def _answered(
    coords: tuple[float, ...] | None, field: Field, axis: int | None = None
) -> tuple[float, ...]:
    if coords is None or (axis is None and places_of(field.cases[0].numbers) is None):
        raise Unanswerable
    return coords


def _opening(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> Any:
    if unit_of(field) == "tick":
        return arm.encoder(arm.joints, now)
    return round(arm.gripper.position(now)[0])


def _speeds(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> Any:
    if unit_of(field) == "revolution_per_minute":
        return _one(tuple(round(v * TURNS_A_MINUTE, 2) for v in arm.angles.speed(now)), joint)
    return _one(arm.servo_speeds(now), joint)


def _reached(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> bool:
    query = as_reached_query(command)
    target, standing, (degrees, millimetres) = given[query.row], arm.standing(now), arm.near
    kind = given[query.kind] if query.kind else next(iter(query.kinds.values()))
    if kind == query.kinds.get(ANGLES):
        return all(abs(have - wish) <= degrees for have, wish in zip(standing, target))
    end = arm.end(standing)
    if end is None or len(target) != len(arm.coordinates):
        raise Unanswerable
    way, turn = end.distance(arm.pose_of(target, standing))
    # Each joint rests up to half a tick from the angle that the target requires.
    return way <= millimetres and turn <= degrees + arm.joints * arm.tick_degrees / 2


def _held(
    arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
) -> Any:
    if joint is not None:
        # The number after the last joint is the gripper's servo, which is always connected.
        return joint > arm.joints or arm.enabled[joint - 1]
    return tuple(arm.enabled) if field.many else all(arm.enabled)


def _plain(read: Callable[[ArmState, float], Any]) -> Read:
    """Return the reader of a state that has one value, or one for each joint."""

    def reader(
        arm: ArmState, now: float, command: Command, field: Field, joint: int | None, given: Any
    ) -> Any:
        value = read(arm, now)
        return _one(tuple(value), joint) if isinstance(value, list) else value

    return reader


READERS: dict[str, Read] = {
    "angles": _angles,
    "planned_angles": _planned_angles,
    "coords": _coords,
    "base_coords": _base_coords,
    "planned_coords": _planned_coords,
    "opening": _opening,
    "speeds": _speeds,
    "reached": _reached,
    "held": _held,
    # A braking arm still moves; one that is led by hand does not move by itself.
    "moving": _plain(lambda arm, now: arm.angles.moving(now) and not arm.released),
    "gripper_moving": _plain(lambda arm, now: arm.gripper.moving(now)),
    "powered": _plain(lambda arm, now: arm.powered),
    "free": _plain(lambda arm, now: arm.free),
    "paused": _plain(lambda arm, now: arm.paused),
    "connected": _plain(lambda arm, now: arm.connected),
    "error": _plain(lambda arm, now: arm.error),
    "lowest": _plain(lambda arm, now: arm.minimum),
    "highest": _plain(lambda arm, now: arm.maximum),
    "starts": _plain(lambda arm, now: arm.starts),
}


def _hold(arm: ArmState, now: float, value: Any, joint: int | None) -> None:
    # A number that no joint has means every joint, but the next one is the gripper's servo.
    if joint == arm.joints + 1:
        return
    every = joint is None or joint > arm.joints
    for at in range(arm.joints) if joint is None or every else [joint - 1]:
        arm.enabled[at] = arm.powered and bool(value)


def _limit(limits: list[float], joints: int, value: Any, joint: int | None) -> None:
    row = value if isinstance(value, tuple | list) else (value,) * joints
    for at in range(joints) if joint is None else [joint - 1]:
        limits[at] = row[at]


def _lowest(arm: ArmState, now: float, value: Any, joint: int | None) -> None:
    _limit(arm.minimum, arm.joints, value, joint)


def _highest(arm: ArmState, now: float, value: Any, joint: int | None) -> None:
    _limit(arm.maximum, arm.joints, value, joint)


def _assign(name: str) -> Write:
    def write(arm: ArmState, now: float, value: Any, joint: int | None) -> None:
        setattr(arm, name, value if name == "error" else bool(value))

    return write


def _to_base_coords(arm: ArmState, now: float, value: Any, joint: int | None) -> None:
    # No source states where an arm is mounted on the body.
    raise Unanswerable


def _open(arm: ArmState, now: float, value: Any, joint: int | None) -> None:
    arm.gripper.place((float(value),), now)


WRITERS: dict[str, Write] = {
    "opening": _open,
    "base_coords": _to_base_coords,
    "powered": _assign("powered"),
    "connected": _assign("connected"),
    "free": _assign("free"),
    "error": _assign("error"),
    "held": _hold,
    "lowest": _lowest,
    "highest": _highest,
}


def after_writing(arm: ArmState, now: float, given: Mapping[str, Any], *, led: bool) -> None:
    """Let the motion follow what was set: power, torque or limits.

    Args:
        arm: the arm.
        now: the time.
        given: the states that were set, with their values.
        led: whether no joint was held before.
    """
    off = {("powered", False), ("held", False), ("free", True)}
    if not given.get("powered", True):
        arm.gripper.halt(now)
        arm.enabled = [False] * arm.joints
    if any((state, bool(value)) in off for state, value in given.items()):
        arm.release(now)
    elif led:
        arm.hold(now)
    if given.keys() & {"lowest", "highest"}:
        _obey_limits(arm, now)


def _obey_limits(arm: ArmState, now: float) -> None:
    """End a motion that would lead a joint beyond its new limits."""
    angles = arm.angles
    points = [angles.position(now), angles.stop_at(now), *angles.ways(now)]
    for turns, (low, high) in zip(zip(*points), arm.limits()):
        if len(set(turns)) == 1 or all(low <= angle <= high for angle in turns):
            continue
        arm.angles.brake(now)
        arm.remarks.append("stopped: the motion leads beyond the new limits")
        return
