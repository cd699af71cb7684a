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
from cobotwire.protocol.refusals import refusals
from cobotwire.protocol.table import Command, Table

# The position of a gripper is its opening in percent.
GRIPPER, OPENINGS = "gripper.pos", (0.0, 100.0)
# For each use, a function that returns whether a command has the effect that the use needs.
_USES: dict[str, Callable[[Effect | None], bool]] = {
    "read gripper": lambda e: isinstance(e, Reports) and [*e.values.values()] == ["opening"],
    "move gripper": lambda e: isinstance(e, Moves) and e.part == "gripper" and type(e.to) is str,
    "release all motors": lambda e: isinstance(e, Sets) and e == Sets({"held": False}),
    "choose targets": lambda e: isinstance(e, Stores) and [*e.values.values()] == ["fresh_mode"],
}


def find(table: Table, use: str) -> Command | None:
    """Return the command for a use; None if the edition has none."""
    return next((each for each in table.commands if _USES[use](effect_of(each))), None)


class Positions:
    """What an arm reports: its joints in degrees, then the opening of its gripper in percent.

    Attributes:
        joints: the names of the joints, base first.
        names: the names of all positions; without the gripper if no command reads its opening.
    """

    def __init__(self, table: Table, gripper: bool) -> None:
        self._joints = table.in_role("joints")
        self._opening = find(table, "read gripper") if gripper else None
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
            UsageError: a limit is not allowed, a workspace needs a geometry that the edition lacks,
                or the edition cannot move a gripper.
        """
        if why := refusals(table, limits).get(table.in_role("joint targets").name):
            raise UsageError("workspace", limits.workspace, message=why)
        ranges = joint_limits(limited(table, limits)) or [(-inf, inf)] * table.joints
        self.limits = dict(zip(joints, ranges, strict=True))
        self.gripper = find(table, "move gripper") if gripper else None
        if self.gripper is not None:
            self.limits[GRIPPER] = OPENINGS
        elif gripper:
            message = f"edition {table.edition} cannot move a gripper: use gripper=false"
            raise UsageError("gripper", gripper, message=message)

    def clip(self, action: Mapping[str, Any]) -> dict[str, float]:
        """Return the nearest targets within the limits.

        Raises:
            UsageError: a target is missing, has an unknown name, or is not a finite number.
        """
        if {*action} != {*self.limits}:
            raise UsageError("the names of the action", list(action), ", ".join(self.limits))
        targets = {name: float(action[name]) for name in self.limits}
        for name, target in targets.items():
            if not isfinite(target):
                raise UsageError(name, target, "a finite number")
        return {n: min(max(targets[n], low), high) for n, (low, high) in self.limits.items()}
