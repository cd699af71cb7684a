"""What the arm does for each command, as the effect that its edition states.

A motion is physics (:mod:`cobotwire.simulator.targets`), and so is the built-in state
(:mod:`cobotwire.simulator.built_in`). Everything else is a value in ``ArmState.kept``, by its name
in the edition. A state with a value for each index is a mapping from the index.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.kinematics import Effort
from cobotwire.protocol.effects import (
    Cases,
    Computes,
    Does,
    Effect,
    Lists,
    Moves,
    Reports,
    Sets,
    State,
    Stores,
    Unknown,
    Zeroes,
    each_case,
    effect_of,
    empty_value,
    states_of,
)
from cobotwire.protocol.fields import Field, named_fields
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.built_in import READERS, WRITERS, Reported, after_writing
from cobotwire.simulator.moves import move
from cobotwire.simulator.replies import Unanswerable
from cobotwire.simulator.state import ArmState
from cobotwire.simulator.targets import is_there, solve

# No source states the maximum length of a list; its length is sent in one byte.
MOST_VALUES = 255

# This joint number means all joints.
EVERY_JOINT = 254

# The state that starts with the values of the edition's `servos`.
REGISTERS = "registers"

Fields = Mapping[str, Any]


class Requested(NamedTuple):
    """A request, and the arm that performs it.

    Attributes:
        table: the edition.
        arm: the arm's state.
        now: the time.
        command: the command.
        fields: the arguments.
    """

    table: Table
    arm: ArmState
    now: float
    command: Command
    fields: Fields

    def replied(self, name: str) -> Field:
        """Return a field of the reply."""
        return named_fields(self.command.reply)[name][0]


def perform(requested: Requested, *, elsewhere: bool = False) -> dict[str, Any]:
    """Perform a command; return the fields that its reply has.

    With ``elsewhere`` the request is for a joint that the arm lacks: its values are stored and have
    no other effect.

    Raises:
        Unanswerable: the arm does not know what the reply reports.
    """
    effect = effect_of(requested.command)
    if isinstance(effect, Cases):
        effect = effect.cases.get(requested.fields[effect.selector])
    if effect is None:
        return {}
    if elsewhere:
        return _keep_or_recall(requested, effect)
    does = _PERFORMED.get(type(effect))
    return (does(requested, effect) if does is not None else None) or {}


def _keep_or_recall(requested: Requested, effect: Effect) -> dict[str, Any]:
    """Store or report a value for a joint that the arm lacks; it is zero at first."""
    kept = requested.arm.elsewhere
    at = getattr(effect, "at", ())
    index = _index(requested, at)
    if isinstance(effect, Reports):
        values = {f: kept.get(state, {}).get(index) for f, state in effect.values.items()}
        return {field: value for field, value in values.items() if value is not None}
    given: dict[str, Any] = {}
    if isinstance(effect, Stores):
        given = {state: requested.fields[name] for name, state in effect.values.items()}
    elif isinstance(effect, Sets):
        given = dict(effect.values)
    elif isinstance(effect, Moves) and isinstance(effect.to, str):
        given = {"angles": requested.fields[effect.to]}
    for state, value in given.items():
        kept.setdefault(state, {})[index] = value
    return {}


def begin(table: Table, arm: ArmState) -> None:
    """Give every state its value at the start."""
    effects = (effect for command in table.commands for effect in each_case(effect_of(command)))
    lists = {effect.state for effect in effects if isinstance(effect, Lists)}
    for name, state in states_of(table).items():
        arm.kept[name] = [] if name in lists else {} if state.each else state.initial
    if isinstance(arm.kept.get(REGISTERS), dict) and arm.servos.registers:
        # One servo more than joints: newer firmware counts the gripper's servo as the last.
        arm.kept[REGISTERS] = {
            (servo, register): value
            for servo in range(1, arm.joints + 2)
            for register, value in arm.servos.registers
        }


def _reports(requested: Requested, effect: Reports) -> dict[str, Any]:
    found = {
        field: _read(requested, field, state, effect.at) for field, state in effect.values.items()
    }
    return {field: value for field, value in found.items() if value is not None}


def _read(requested: Requested, name: str, state: str, at: Sequence[str]) -> Any:
    """Return the value of a state as a field of the reply has it."""
    field = None if requested.command.text is not None else requested.replied(name)
    if state in READERS:
        index = requested.fields[at[0]] if at else None
        assert field is not None, "a built-in state is not a text"
        arm, now, command, fields = (
            requested.arm,
            requested.now,
            requested.command,
            requested.fields,
        )
        return READERS[state](Reported(arm, now, command, field, index, fields))
    declared = states_of(requested.table)[state]
    if not declared.each:
        return requested.arm.kept[state]
    index = _index(requested, at)
    if len(index) == len(declared.each):
        return _kept(requested.arm, declared, index)
    assert field is not None, "a text has no index"
    count = len(field.cases[0].numbers) if field.many else requested.arm.joints
    row = tuple(_kept(requested.arm, declared, (*index, n)) for n in range(1, count + 1))
    return row if field.many else all(row)


def _index(requested: Requested, at: Sequence[str]) -> tuple[int, ...]:
    return tuple(requested.fields[name] for name in at)


def _stores(requested: Requested, effect: Stores) -> None:
    given = {
        state: requested.fields[name]
        for name, state in effect.values.items()
        if name in requested.fields
    }
    _write(requested, given, effect.at)


def _sets(requested: Requested, effect: Sets) -> None:
    _write(requested, effect.values, effect.at)


def _write(requested: Requested, given: Mapping[str, Any], at: Sequence[str]) -> None:
    arm, index = requested.arm, _index(requested, at)
    built_in = {state: value for state, value in given.items() if state in WRITERS}
    declared = states_of(requested.table)
    for state, value in given.items():
        if state in built_in:
            continue
        _keep(arm, declared[state], index, tuple(value) if isinstance(value, list) else value)
    if built_in:
        led = arm.released
        # Without power no joint can be held, so power is switched first.
        for state in sorted(built_in, key="powered".__ne__):
            WRITERS[state](arm, requested.now, built_in[state], index[0] if index else None)
        after_writing(arm, requested.now, built_in, led=led)


def _keep(arm: ArmState, state: State, index: tuple[int, ...], value: Any) -> None:
    """Keep a value for an index.

    If the last index is missing, the value is a row, with an element for each last index, or one
    value that applies to all of them.
    """
    if not state.each:
        arm.kept[state.name] = value
        return
    if index[-1:] == (EVERY_JOINT,) and state.each[len(index) - 1] == "joint":
        index = index[:-1]
    kept: dict[tuple[int, ...], Any] = arm.kept[state.name]
    if len(index) == len(state.each):
        kept[index] = value
    elif state.kind != "value" and isinstance(value, tuple):
        kept.update({(*index, n): each for n, each in enumerate(value, 1)})
    else:
        # One value for all last indices is stored under the indices before them.
        others = {key: each for key, each in kept.items() if key[: len(index)] != index}
        arm.kept[state.name] = others | {index: value}


def _kept(arm: ArmState, state: State, index: tuple[int, ...]) -> Any:
    """Return the value of an index."""
    values: dict[tuple[int, ...], Any] = arm.kept[state.name]
    return values.get(index, values.get(index[:-1], state.initial))


def _moves(requested: Requested, effect: Moves) -> None:
    move(requested.arm, requested.now, requested.command, effect, requested.fields)


def _zeroes(requested: Requested, effect: Zeroes) -> None:
    arm, now = requested.arm, requested.now
    joint = requested.fields[effect.at[0]] if effect.at else None
    if effect.part == "gripper" or joint == arm.joints + 1:
        arm.gripper.place((0.0,), now)
        return
    position = list(arm.angles.position(now))
    for at in range(arm.joints):
        if joint is None or joint > arm.joints or at == joint - 1:
            position[at] = 0.0
    arm.angles.place(position, now)


def _does(requested: Requested, effect: Does) -> None:
    arm, now = requested.arm, requested.now
    if effect.what == "pause":
        arm.paused = True
        arm.angles.pause(now)
    elif effect.what == "resume":
        arm.resume(now)
    elif effect.what == "forget":
        # The sources say nothing about the present motion, so it continues.
        arm.angles.forget(now)
    else:
        # The joints that move together stop together.
        arm.angles.brake(now)
        if effect.what == "stop":
            arm.resume(now)


def _lists(requested: Requested, effect: Lists) -> dict[str, Any] | None:
    values: list[Any] = requested.arm.kept[effect.state]
    if effect.append:
        if len(values) < MOST_VALUES:
            given = requested.fields[effect.append]
            values.append(tuple(given) if isinstance(given, list) else given)
        return None
    if effect.clear:
        values.clear()
    if not requested.command.requires_reply:
        return None
    field = requested.command.reply[0].fields[-1]
    if effect.take:
        zeros = (0,) * len(field.cases[0].numbers) if field.many else 0
        return {field.name: values.pop(0) if values else zeros}
    if effect.report == "empty":
        empty = empty_value(field)
        return {field.name: empty if not values else next(c for c in field.choices if c != empty)}
    return {field.name: len(values)}


def _computes(requested: Requested, effect: Computes) -> dict[str, Any]:
    arm, given = requested.arm, tuple(requested.fields[effect.source])
    name = requested.command.reply[0].fields[-1].name
    if effect.what == "coords":
        # Joints rest on ticks, so for angles from get_angles the reply is the same as from
        # get_coords.
        coords = arm.reported_coords(arm.on_ticks(given))
        if coords is None:
            raise Unanswerable
        return {name: coords}
    if arm.geometry is None:
        raise Unanswerable
    near = tuple(requested.fields[effect.near]) if effect.near else arm.standing(requested.now)
    if is_there(arm, given, near):
        return {name: near}
    # No source defines the reply if there is no solution. It has the angles ``near``, and the arm
    # has an error.
    found = solve(arm, arm.pose_of(given, near), near, Effort())
    return {name: near if found is None else found}


def _unknown(requested: Requested, effect: Unknown) -> None:
    if requested.command.safety != "query":
        requested.arm.remarks.append(f"ignored: {effect.why[0].lower()}{effect.why[1:]}")


_PERFORMED: dict[type, Callable[[Requested, Any], dict[str, Any] | None]] = {
    Reports: _reports,
    Stores: _stores,
    Sets: _sets,
    Moves: _moves,
    Zeroes: _zeroes,
    Does: _does,
    Lists: _lists,
    Computes: _computes,
    Unknown: _unknown,
}
