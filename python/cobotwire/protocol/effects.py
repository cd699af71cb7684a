"""What a command does, as its edition states it: the state that it reports, stores or sets.

The effect of a command is one of the records below. What an arm keeps is declared by the edition
(:func:`states_of`), or built in: the angles, whether the arm moves, and so on
(``language/words.py`` of the generator lists the built-in state).

Every record has ``assumed``: why no source states the effect; empty if one does. A simulated arm
has an assumed effect too, but testers do not test it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from typing import Any, Literal, NamedTuple

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.robot import real
from cobotwire.protocol.roles import is_of_gripper
from cobotwire.protocol.table import Command, Field, Table

# The state of an arm that says whether a new target replaces the present one.
FRESH = "fresh_mode"

Part = Literal["joints", "joint", "end", "gripper"]
Control = Literal["stop", "halt", "pause", "resume", "forget"]


class State(NamedTuple):
    """One item of the state of an arm.

    Attributes:
        name: its name.
        kind: the kind of its type, such as ``quantity`` or ``value`` (a row); empty for a text.
        size: how many numbers a value has.
        each: the types of the indices; there is a value for each index. Empty: one value.
        start: the value at the start; None: zero, or no text.
    """

    name: str
    kind: str = ""
    size: int = 1
    each: tuple[str, ...] = ()
    start: Any = None

    @property
    def initial(self) -> Any:
        """The value at the start, of one index; None if only a message can give one."""
        if isinstance(self.start, list):
            return tuple(map(real, self.start))
        if self.start is not None:
            return real(self.start) if self.kind and isinstance(self.start, str) else self.start
        if self.kind in ("bits", "bytes", "text", "list"):
            return None
        zero: Any = "" if not self.kind else False if self.kind == "flag" else 0
        return (zero,) * self.size if self.kind == "value" else zero


class Reports(NamedTuple):
    """A query reports state: ``values`` has the state of each field of the reply."""

    values: Mapping[str, str]
    at: tuple[str, ...] = ()
    assumed: str = ""


class Stores(NamedTuple):
    """A command stores arguments: ``values`` has the state of each argument."""

    values: Mapping[str, str]
    at: tuple[str, ...] = ()
    assumed: str = ""


class Sets(NamedTuple):
    """A command gives each state in ``values`` a fixed physical value."""

    values: Mapping[str, Any]
    at: tuple[str, ...] = ()
    assumed: str = ""


class Moves(NamedTuple):
    """A command moves the joints, one joint, the end of the arm or the gripper.

    Attributes:
        part: what moves.
        at: the argument that chooses the joint.
        to: the argument with the target, or the target.
        by: the argument with the distance.
        until: ``limit`` if the motion continues until it is stopped.
        about: the argument with the axis.
        keeps: ``position`` if the end of the arm turns in place.
        direction: the argument with the direction.
        speed: the argument with the speed.
        assumed: why no source states it.
    """

    part: Part
    at: tuple[str, ...] = ()
    to: str | float | None = None
    by: str = ""
    until: str = ""
    about: str = ""
    keeps: str = ""
    direction: str = ""
    speed: str = ""
    assumed: str = ""


class Zeroes(NamedTuple):
    """The present position of a part becomes its zero."""

    part: Part
    at: tuple[str, ...] = ()
    assumed: str = ""


class Does(NamedTuple):
    """A command controls the motion under way."""

    what: Control
    at: tuple[str, ...] = ()
    assumed: str = ""


class Lists(NamedTuple):
    """A command appends to a list, takes its first value, clears it, or reports on it.

    Attributes:
        state: the list.
        append: the argument that is appended.
        take: ``first`` if the reply has the first value, which leaves the list.
        empty: ``zeros`` if that reply has zeros when the list is empty.
        clear: ``all`` if the list becomes empty.
        report: ``count`` or ``empty``: what the reply has.
        assumed: why no source states it.
    """

    state: str
    append: str = ""
    take: str = ""
    empty: str = ""
    clear: str = ""
    report: str = ""
    assumed: str = ""


class Computes(NamedTuple):
    """A query computes ``what`` from the argument ``source``, near the angles in ``near``."""

    what: Literal["coords", "angles"]
    source: str
    near: str = ""
    assumed: str = ""


class Cases(NamedTuple):
    """The effect depends on an argument: ``cases`` has the effect for each raw value of it."""

    selector: str
    cases: Mapping[int, Effect]
    assumed: str = ""


class Code(NamedTuple):
    """The effect is implemented in code; ``what`` describes it in words."""

    what: str
    assumed: str = ""


class Unknown(NamedTuple):
    """No source says what the command does; ``why`` is what is missing."""

    why: str
    assumed: str = ""


Effect = Reports | Stores | Sets | Moves | Zeroes | Does | Lists | Computes | Cases | Code | Unknown


@cache
def effect_of(command: Command) -> Effect | None:
    """Return what a command does; None if the edition does not state it."""
    return None if command.stated_effect is None else _effect(command.stated_effect)


def each_case(effect: Effect | None) -> Iterator[Effect]:
    """Yield an effect, or the effect of each of its cases."""
    if isinstance(effect, Cases):
        yield from effect.cases.values()
    elif effect is not None:
        yield effect


def fresh_mode(table: Table) -> tuple[Command, str, Command | None]:
    """Return the setting that decides whether a new target replaces the present one, and its query.

    Returns:
        The setting; its argument, which is 1 if a new target replaces the old one and 0 if it
        waits; the query, None if the edition has none.

    Raises:
        UsageError: the edition has no such setting.
    """
    setting = query = None
    for command in table.commands:
        effect = effect_of(command)
        if isinstance(effect, Reports) and FRESH in effect.values.values():
            query = command
        elif isinstance(effect, Stores) and FRESH in effect.values.values():
            argument = next(name for name, state in effect.values.items() if state == FRESH)
            setting = command, argument
    if setting is not None:
        return *setting, query
    message = (
        f"edition {table.edition} has no command by which a new target replaces the present one, "
        "so the arm would queue the targets of a path"
    )
    raise UsageError("edition", table.edition, message=message)


def ends_motion(table: Table, command: Command) -> bool:
    """Return whether a command is meant to end or interrupt a motion of the arm, or may do so.

    It stops or pauses the arm, discards targets, or has the safety class power and may take power
    from a joint. No command for the gripper ends a motion of the arm.
    """
    if is_of_gripper(table, command):
        return False
    if command.is_stop:
        return True
    cases = list(each_case(effect_of(command)))
    if any(isinstance(each, Does) and each.what != "resume" for each in cases):
        return True
    return command.safety == "power" and not (cases and all(map(_holds_joints, cases)))


def _holds_joints(effect: Effect) -> bool:
    """Return whether an effect leaves power on the joints."""
    values = effect.values if isinstance(effect, Sets) else {}
    return values.get("held", values.get("powered")) is True


def empty_value(field: Field) -> int:
    """Return the raw value that reports an empty list: the value of EMPTY, or else 1."""
    return dict(zip(field.labels, field.choices)).get("EMPTY", 1)


@lru_cache(maxsize=64)  # a simulated arm looks a state up for each query
def states_of(table: Table) -> Mapping[str, State]:
    """Return the state that an edition declares for its arm, by name."""
    return {
        name: State(
            name,
            record.get("kind", ""),
            record.get("size", 1),
            tuple(record.get("each", ())),
            record.get("start"),
        )
        for name, record in table.robot.state.items()
    }


# The record for the verb of an effect: the key that says what the command does. The value of the
# key becomes the first field of the record.
_RECORDS: dict[str, Any] = {
    "reports": Reports,
    "stores": Stores,
    "sets": Sets,
    "moves": Moves,
    "zeroes": Zeroes,
    "does": Does,
    "list": Lists,
    "computes": Computes,
    "python": Code,
    "unknown": Unknown,
}


def _effect(record: Mapping[str, Any]) -> Effect:
    if "selector" in record:
        cases = {int(raw): _effect(inner) for raw, inner in record["cases"].items()}
        return Cases(record["selector"], cases)
    verb = next(key for key in _RECORDS if key in record)
    options = {("source" if k == "from" else k): v for k, v in record.items() if k != verb}
    if "at" in options:
        options["at"] = tuple(options["at"])
    made: Effect = _RECORDS[verb](record[verb], **options)
    return made
