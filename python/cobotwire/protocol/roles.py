"""Find the arguments of commands by their roles, for any number of joints.

Editions order arguments differently, so the type of an argument identifies it. The targets of all
joints are the argument with several numbers. The target of one joint or coordinate has a selector,
a unit or a scale. A speed is in percent.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.fields import Field, Variant
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Role, Table

# The kinds of target, named like the enum labels in an edition's ``reached`` query.
ANGLES, COORDS = "ANGLES", "COORDS"
KINDS = {ANGLES: 0, COORDS: 1}


class Picked(NamedTuple):
    """The positions of two fields: the one that picks a joint or coordinate, and its target."""

    picker: int
    target: int


def row_index(variant: Variant) -> int:
    """Return the index of the first field with several numbers; -1 if no field has several."""
    return next((index for index, field in enumerate(variant.fields) if field.many), -1)


def picked(variant: Variant) -> Picked:
    """Return the field positions in a command that moves one joint or coordinate.

    The generator checks that the command of that role has such fields.
    """
    fields = variant.fields
    for index, field in enumerate(fields):
        if field.selector >= 0:
            return Picked(field.selector, index)
    target = next(index for index, field in enumerate(fields) if _is_target(field))
    return Picked(next(i for i, field in enumerate(fields) if _is_picker(field)), target)


def _is_target(field: Field) -> bool:
    number = field.cases[0].numbers[0]
    # A number in percent is the speed.
    return number.unit != "percent" and not _is_picker(field)


def _is_picker(field: Field) -> bool:
    number = field.cases[0].numbers[0]
    return not number.scaled and not number.unit


def targets_request(command: Command, target: Sequence[float], *others: Any) -> Request[Any]:
    """Return the request that moves all joints or coordinates to ``target``.

    ``others`` are the remaining arguments, in the order of the method.

    Raises:
        UsageError: a required argument is missing, or ``others`` has too many.
    """
    names: tuple[str, ...] = command.request_type.__match_args__
    row = command.request[0].fields[row_index(command.request[0])].name
    rest = [name for name in names if name != row]
    given = dict(zip(rest, others))
    if len(others) > len(rest):
        message = f"{command.name}() has no argument for {others[len(rest)]!r}"
        raise UsageError("arguments", others[len(rest)], message=message)
    for name in rest:
        if name not in given and name not in command.request_type.__dict__:
            raise UsageError(name, message=f"{command.name}() needs its argument {name}")
    return command.request_type(**{row: target}, **given)


class ReachedQuery(NamedTuple):
    """The query that reports whether a target is reached.

    Attributes:
        command: the query.
        row: the argument that holds the target.
        kind: the argument that holds the kind of target; empty if the query takes only one kind.
        kinds: the raw value of each kind that the query takes.
    """

    command: Command
    row: str
    kind: str
    kinds: dict[str, int]

    def request(self, target: Sequence[float], label: str) -> Request[Any]:
        """Return the request for a target; ``label`` is one of ``kinds``."""
        kind = {self.kind: self.kinds[label]} if self.kind else {}
        return self.command.request_type(**{self.row: target}, **kind)


def reached_query(table: Table) -> ReachedQuery | None:
    """Return the query in the role ``reached``; None if the edition has none."""
    command = table.find_role("reached")
    return None if command is None else as_reached_query(command)


def as_reached_query(command: Command) -> ReachedQuery:
    """Return the description of a command that has the role ``reached``."""
    variant = command.request[0]
    row = variant.fields[row_index(variant)].name
    for field in variant.fields:
        if field.const is not None:
            kinds = {label: raw for label, raw in KINDS.items() if raw == field.const}
            return ReachedQuery(command, row, "", kinds)
        if not field.many and field.labels:
            raws = dict(zip(field.labels, field.choices))
            return ReachedQuery(command, row, field.name, {k: raws[k] for k in KINDS if k in raws})
    return ReachedQuery(command, row, "", {ANGLES: KINDS[ANGLES]})


def kinds_of(table: Table) -> dict[str, int]:
    """Return the raw value of each kind of target: from the edition, otherwise from KINDS."""
    query = reached_query(table)
    return KINDS | ({} if query is None else query.kinds)


def gripper_request(table: Table, label: str, speed: int) -> Request[Any]:
    """Return the request that opens (OPEN) or closes (CLOSE) the gripper.

    Raises:
        UsageError: no command of the edition does that.
    """
    command = table.in_role("gripper")
    state = command.request[0].fields[0]
    speed_name = command.request[0].fields[1].name
    raw = state.choices[state.labels.index(label)]
    return command.request_type(**{state.name: raw, speed_name: speed})


def position_role(label: str) -> Role:
    """Return the role of the query that reports the present angles or coordinates."""
    return "joints" if label == ANGLES else "coordinates"


def starts_motion(table: Table, command: Command) -> bool:
    """Return whether a command of the class motion may set the arm or its gripper in motion.

    Commands that stop, pause or discard targets never do. Resuming only continues a paused motion.
    """
    if command.safety != "motion" or command.is_stop:
        return False
    back = command.read_by
    return back is None or table.command(back.query).role != "paused"


def may_move(table: Table, command: Command) -> bool:
    """Return whether the arm or its gripper may move after a command of the class motion.

    These are the commands that start a motion, and the one that resumes a paused motion.
    """
    return starts_motion(table, command) or command == table.find_setter("paused", 0)


def moves_arm(table: Table, command: Command) -> bool:
    """Return whether a command may set joints in motion; one for the gripper does not."""
    return starts_motion(table, command) and not is_of_gripper(table, command)


def is_of_gripper(table: Table, command: Command) -> bool:
    """Return whether a command is for the gripper, which has its own servo."""
    gripper = table.find_role("gripper")
    fields = {field.name for variant in command.request for field in variant.fields}
    return (gripper is not None and command.family == gripper.family) or "gripper_id" in fields
