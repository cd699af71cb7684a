"""The state that every arm has: what it reports, and what happens when a command sets it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.kinematics.coordinates import indices_of
from cobotwire.protocol.fields import Field
from cobotwire.protocol.roles import ANGLES, as_reached_query
from cobotwire.protocol.table import Command
from cobotwire.simulator.replies import Unanswerable
from cobotwire.simulator.state import ArmState

# One degree per second, in turns per minute.
TURNS_A_MINUTE = 60 / 360


class Reported(NamedTuple):
    """A field of a reply that reports a state.

    Attributes:
        arm: the arm.
        now: the time.
        command: the query.
        field: the field.
        which: the joint or axis, counted from 1; None: all of them.
        given: the arguments.
    """

    arm: ArmState
    now: float
    command: Command
    field: Field
    which: int | None
    given: Mapping[str, Any]

    @property
    def unit(self) -> str:
        """The unit of the field."""
        return unit_of(self.field)

    def one_of(self, values: Sequence[Any]) -> Any:
        """Return the value of the joint or axis; if none is chosen, all values.

        Raises:
            Unanswerable: there is no such value.
        """
        if self.which is None:
            return tuple(values)
        if not 0 < self.which <= len(values):
            raise Unanswerable(f"no source says what is reported for joint {self.which}")
        return values[self.which - 1]

    def place(self, coords: tuple[float, ...] | None) -> Any:
        """Return coordinates of the end.

        Raises:
            Unanswerable: the arm has no geometry, or none for this field.
        """
        known = self.which is not None or indices_of(self.field.cases[0].numbers) is not None
        if coords is None or not known:
            raise Unanswerable
        return self.one_of(coords)


Write = Callable[[ArmState, float, Any, "int | None"], None]


def unit_of(field: Field) -> str:
    """Return the unit of a field's first number."""
    return field.cases[0].numbers[0].unit


def _angles(shown: Reported) -> Any:
    arm, now = shown.arm, shown.now
    if shown.unit != "tick":
        return _in_unit(shown, arm.angles.position(now))
    # The servo after the last joint is the gripper's.
    each = range(arm.joints if shown.which is None else arm.joints + 1)
    return shown.one_of([arm.encoder(joint, now) for joint in each])


def _in_unit(shown: Reported, angles: tuple[float, ...]) -> Any:
    degrees = shown.arm.reported_angles(angles)
    return shown.one_of([*map(math.radians, degrees)] if shown.unit == "radian" else degrees)


def _opening(shown: Reported) -> int:
    arm, now = shown.arm, shown.now
    return (
        arm.encoder(arm.joints, now)
        if shown.unit == "tick"
        else round(arm.gripper.position(now)[0])
    )


def _speeds(shown: Reported) -> Any:
    arm, now = shown.arm, shown.now
    if shown.unit == "revolution_per_minute":
        return shown.one_of([round(each * TURNS_A_MINUTE, 2) for each in arm.angles.speed(now)])
    return shown.one_of(arm.servo_speeds(now))


def _reached(shown: Reported) -> bool:
    arm, query = shown.arm, as_reached_query(shown.command)
    target, standing, (degrees, millimetres) = (
        shown.given[query.row],
        arm.standing(shown.now),
        arm.near,
    )
    if not isinstance(target, tuple):
        raise Unanswerable("no source says what the target is")
    kind = shown.given[query.kind] if query.kind else next(iter(query.kinds.values()))
    if kind == query.kinds.get(ANGLES):
        return all(abs(have - wish) <= degrees for have, wish in zip(standing, target))
    end = arm.end(standing)
    if end is None or len(target) != len(arm.coordinates):
        raise Unanswerable
    distance, turn = end.distance(arm.pose_of(target, standing))
    # Each joint rests up to half a tick from the angle that the target requires.
    return distance <= millimetres and turn <= degrees + arm.joints * arm.tick_degrees / 2


def _held(shown: Reported) -> Any:
    if shown.which is None and not shown.field.many:
        return all(shown.arm.enabled)
    # The number after the last joint is the gripper's servo, which is always connected.
    return shown.one_of([*shown.arm.enabled, *([True] if shown.which else [])])


def _attribute(name: str) -> Callable[[Reported], Any]:
    return lambda shown: getattr(shown.arm, name)


# The attributes of the arm's state that are reported without conversion.
SIMPLE = ("powered", "free", "paused", "connected", "error", "starts")
READERS: dict[str, Callable[[Reported], Any]] = {
    "angles": _angles,
    "planned_angles": lambda shown: _in_unit(shown, shown.arm.angles.target(shown.now)),
    "coords": lambda shown: shown.place(shown.arm.reported_coords(shown.arm.standing(shown.now))),
    "base_coords": lambda shown: shown.place(
        shown.arm.reported_coords(shown.arm.standing(shown.now), base=True)
    ),
    "planned_coords": lambda shown: shown.place(
        shown.arm.reported_coords(shown.arm.angles.target(shown.now), base=True)
    ),
    "opening": _opening,
    "speeds": _speeds,
    "reached": _reached,
    "held": _held,
    # A braking arm still moves; one that is led by hand does not move by itself.
    "moving": lambda shown: shown.arm.angles.moving(shown.now) and not shown.arm.released,
    "gripper_moving": lambda shown: shown.arm.gripper.moving(shown.now),
    "lowest": lambda shown: shown.one_of(shown.arm.minimum),
    "highest": lambda shown: shown.one_of(shown.arm.maximum),
    **{name: _attribute(name) for name in SIMPLE},
}


def _hold(arm: ArmState, now: float, value: Any, joint: int | None) -> None:
    # The number after the last joint is the gripper's servo; higher numbers mean every joint.
    if joint in (0, arm.joints + 1):
        return
    every = joint is None or joint > arm.joints
    for at in range(arm.joints) if joint is None or every else [joint - 1]:
        arm.enabled[at] = arm.powered and bool(value)


def _limit(limits: list[float], joints: int, value: Any, joint: int | None) -> None:
    row = value if isinstance(value, tuple | list) else (value,) * joints
    if joint is not None and not 0 < joint <= joints:
        raise Unanswerable(f"the arm has no joint {joint}")
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
    """Make the motion obey what was set: power, torque or limits.

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
    points = [angles.position(now), angles.stop_at(now), *angles.points_ahead(now)]
    for turns, (low, high) in zip(zip(*points), arm.limits()):
        if len(set(turns)) == 1 or all(low <= angle <= high for angle in turns):
            continue
        arm.angles.brake(now)
        arm.remarks.append("stopped: the motion leads beyond the new limits")
        return
