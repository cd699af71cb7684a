"""The joints and the gripper of an edition, with the names that LeRobot gives to their positions.

Commands are found by the roles and effects that the edition states.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf, isfinite
from typing import Any

from cobotwire import Limits, UsageError
from cobotwire.protocol.effects import Effect, Moves, Reports, Sets, Stores, effect_of
from cobotwire.protocol.limits import joint_limits, limited
from cobotwire.protocol.table import Command, Table

GRIPPER = "gripper.pos"
# The opening of a gripper, in percent.
CLOSED, OPEN = 0.0, 100.0
# How editions call the mode in which a new target replaces the present one.
NEWEST = ("REFRESH", "NEWEST")


class Positions:
    """What an arm reports: its joints in degrees, then the opening of its gripper in percent.

    Attributes:
        joints: the names of the joints, base first.
        names: the names of all positions: no gripper, if the edition cannot read its opening.
    """

    def __init__(self, table: Table, gripper: bool) -> None:
        """Find the queries."""
        opening = _find(table, lambda e: isinstance(e, Reports) and _only(e.values, "opening"))
        self._joints = table.in_role("joints")
        self._opening = opening if gripper else None
        self.joints = [f"joint{number}.pos" for number in range(1, table.joints + 1)]
        self.names = self.joints + ([GRIPPER] if self._opening else [])

    def read(self, arm: Any) -> dict[str, float]:
        """Return where the arm of a client is."""
        positions = [*getattr(arm, self._joints.name)()]
        if self._opening is not None:
            positions.append(getattr(arm, self._opening.name)())
        return dict(zip(self.names, map(float, positions), strict=True))


class Targets:
    """Where an arm with motors can be sent: its joints, then its gripper.

    Attributes:
        limits: the lowest and the highest target of each name.
        gripper: the command for the gripper; None if there is no gripper.
    """

    def __init__(self, table: Table, joints: list[str], gripper: bool, limits: Limits) -> None:
        """Take the limits of the edition, narrowed by ``limits``.

        Raises:
            UsageError: a limit is not allowed, or the edition has no command for the gripper.
        """
        ranges = joint_limits(limited(table, limits)) or [(-inf, inf)] * table.joints
        self.limits = dict(zip(joints, ranges, strict=True))
        self.gripper = _find(table, _opens_gripper) if gripper else None
        if self.gripper is not None:
            self.limits[GRIPPER] = (CLOSED, OPEN)
        elif gripper:
            message = f"edition {table.edition} cannot move a gripper: use gripper=false"
            raise UsageError("gripper", gripper, message=message)

    def clip(self, action: Mapping[str, Any]) -> dict[str, float]:
        """Return the nearest targets within the limits.

        Raises:
            UsageError: a target is missing, is not a finite number, or is for no joint.
        """
        if {*action} != {*self.limits}:
            raise UsageError("the names of the action", list(action), ", ".join(self.limits))
        targets = {name: float(action[name]) for name in self.limits}
        for name, target in targets.items():
            if not isfinite(target):
                raise UsageError(name, target, "a finite number")
        return {n: min(max(targets[n], low), high) for n, (low, high) in self.limits.items()}


def release_command(table: Table) -> Command:
    """Return the command that releases the motors of all joints and leaves the power on.

    Raises:
        UsageError: the edition has none.
    """
    found = _find(table, lambda e: isinstance(e, Sets) and e == Sets({"held": False}))
    if found is None:
        message = f"edition {table.edition} has no command that releases all motors"
        raise UsageError("released", True, message=message)
    return found


def newest_target_mode(table: Table) -> tuple[Command, int] | None:
    """Return the command and the mode in which a new target replaces all earlier ones."""
    found = _find(table, lambda e: isinstance(e, Stores) and _only(e.values, "fresh_mode"))
    if found is None:
        return None
    mode = found.request[0].fields[0]
    raws = dict(zip(mode.labels, mode.choices))
    return found, next(raws[label] for label in NEWEST if label in raws)


def _find(table: Table, matches: Callable[[Effect | None], bool]) -> Command | None:
    return next((each for each in table.commands if matches(effect_of(each))), None)


def _only(values: Mapping[str, str], state: str) -> bool:
    return [*values.values()] == [state]


def _opens_gripper(effect: Effect | None) -> bool:
    return isinstance(effect, Moves) and effect.part == "gripper" and isinstance(effect.to, str)
