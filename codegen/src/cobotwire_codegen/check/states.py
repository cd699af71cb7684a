"""Rules for state: each has a value at the start, and fits the fields that report and set it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from cobotwire_codegen.build.effects import given, reported, states_named
from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.language.words import BUILT_IN
from cobotwire_codegen.model import Command, Edition, Effect, Field, Quantity, State, Type
from cobotwire_codegen.publish_effects import plain

# Built-in states that are true or false, then those with a value for each joint, or each axis.
_SWITCHES = ("powered", "connected", "free", "held")
_JOINT_ROWS = ("angles", "planned_angles", "speeds", "held", "lowest", "highest")
_AXIS_ROWS = ("coords", "base_coords", "planned_coords")
# States that can have one value for all joints: whether all are held, or a limit of all.
_AS_ONE = {"reports": ("held",), "stores": ("held", "lowest", "highest")}


def states_fit(edition: Edition) -> Iterator[Problem]:
    """Report states that hide a built-in one, unknown indices, and starts of the wrong type."""
    types = {type.name for type in edition.types}
    for state in edition.states:
        for each in state.each:
            if each not in types:
                message = (
                    f"{state.name} is for each {each}, which is not a type{nearest(each, types)}"
                )
                yield Problem(state.place, "unknown-type", message)
        if state.name in BUILT_IN:
            message = f"{state.name} is a built-in state of every arm; remove its declaration"
            yield Problem(state.place, "bad-state", message)
        if state.start is None:
            continue
        wrong = wrong_value(state.name, state, state.start)
        if wrong:
            yield Problem(state.place, "bad-start-value", f"start of {state.name}: {wrong}")


def wrong_value(name: str, state: State | None, value: object) -> str:
    """Return why a state cannot have a value; empty if it can.

    ``state`` is None for a built-in state.
    """
    if state is not None and state.type is not None:
        try:
            plain(state.type, name, value)
        except ValueError as error:
            return str(error)
        return ""
    if state is not None:
        fits = isinstance(value, str) and value.isprintable()
        return "" if fits else f"{name} must be a text of printable characters"
    if name in _SWITCHES:
        return "" if isinstance(value, bool) else f"{name} must be true or false"
    return "" if type(value) in (int, Fraction) else f"{name} must be a number"


def no_contradictions(edition: Edition) -> Iterator[Problem]:
    """Report state that nothing gives a value, starts stated twice, and motions without an end."""
    effects = [
        (command, inner)
        for command in edition.commands
        if command.effect is not None
        for inner in (command.effect, *(each for _, each in command.effect.cases))
    ]
    given_values = {state for _, effect in effects for state in _changed(effect)}
    used = {name for command in edition.commands for name in states_named(command.effect)}
    listed = {effect.what: command for command, effect in effects if effect.verb == "list"}
    for command, effect in effects:
        for name in (*_changed(effect), *_reported_states(effect)):
            if effect.verb != "list" and name in listed:
                message = f"{name} is a list for {listed[name].name}, but one value here"
                yield Problem(effect.place, "bad-effect", f"{message} (effect of {command.name})")
    for state in edition.states:
        if state.name not in used:
            message = f"no command reports, stores or sets {state.name}"
            yield Problem(state.place, "bad-state", message)
        readers = [c.name for c, e in effects if state.name in _reported_states(e)]
        charted = state.name == REGISTERS and edition.robot.servos is not None
        stated = charted or state.start is not None or state.name in given_values
        if readers and not stated:
            message = f"{readers[0]} reports {state.name}, but nothing sets it: state a start"
            yield Problem(state.place, "bad-state", message)
        if charted and state.start is not None:
            message = f"{state.name} has two starts: `start`, and the registers of the servos"
            yield Problem(state.place, "bad-state", message)
    ends = any(e.verb == "does" and e.what in ("stop", "halt") for _, e in effects)
    for command, effect in effects:
        if effect.verb == "moves" and effect.option("until") and not ends:
            message = f"{command.name} moves until it is stopped, but no command stops a motion"
            yield Problem(effect.place, "bad-effect", message)


# The state that starts with the registers that `servos` of the edition states.
REGISTERS = "registers"


def _changed(effect: Effect) -> list[str]:
    """Return the states that an effect sets; code may set more."""
    if effect.verb == "list":
        return [effect.what]
    values = effect.values
    names = {"stores": [str(state) for _, state in values], "sets": [name for name, _ in values]}
    return names.get(effect.verb, [])


def _reported_states(effect: Effect) -> list[str]:
    return [str(state) for _, state in effect.values] if effect.verb == "reports" else []


def values_fit(edition: Edition) -> Iterator[Problem]:
    """Report fields with values that a state cannot have, and indices that it lacks."""
    types = {type.name: type for type in edition.types}
    for command in edition.commands:
        effect = command.effect
        cases = effect.cases if effect is not None else ()
        for each in (effect, *(inner for _, inner in cases)):
            # In a case, the selector is one value of its type.
            chosen = effect.what if effect is not None and each is not effect else ""
            for message in _misfits(each, command, edition, types, chosen):
                place = command.place if each is None else each.place
                yield Problem(place, "bad-effect", f"{message} (effect of {command.name})")


def _misfits(
    effect: Effect | None,
    command: Command,
    edition: Edition,
    types: Mapping[str, Type],
    chosen: str,
) -> Iterator[str]:
    states = {state.name: state for state in edition.states}
    if effect is not None and effect.verb == "list" and effect.what in states:
        yield from _unlike_list(effect, command, states[effect.what])
    if effect is None or effect.verb not in ("reports", "stores", "sets"):
        return
    fields = reported(command) if effect.verb == "reports" else given(command)
    for key, value in effect.values:
        name = key if effect.verb == "sets" else str(value)
        field, state = fields.get(key), states.get(name)
        if effect.verb == "sets":
            field = None
        elif key not in fields:
            continue
        if state is not None:
            if effect.verb != "sets":
                yield from _unlike(field, state, effect.at, key)
            yield from _beyond(effect, given(command), state, types, chosen)
        elif name in BUILT_IN and not effect.by_role:
            yield from _unlike_built_in(field, name, effect, edition.joints)


def _unlike_list(effect: Effect, command: Command, state: State) -> Iterator[str]:
    """Yield why a field cannot be a value of a list."""
    if state.each:
        yield f"{state.name} is a list, so it cannot have `each`"
    added = given(command).get(str(effect.option("append")))
    if added is not None:
        yield from _unlike(added, state, (), added.name)
    if effect.option("take"):
        for name, field in list(reported(command).items())[-1:]:
            yield from _unlike(field, state, (), name)


def _unlike_built_in(field: Field | None, name: str, effect: Effect, joints: int) -> Iterator[str]:
    """Yield why a field cannot have the value of a built-in state."""
    row = name in _JOINT_ROWS or name in _AXIS_ROWS
    size = 0 if field is None else len(field.type.parts)
    if len(effect.at) > (1 if row else 0):
        given = f"`at` names {len(effect.at)} argument(s)"
        yield f"{name} has {'one index' if row else 'no index'}, but {given}"
    elif effect.verb != "sets" and field is None:
        yield f"{name} is not a text"
    elif field is not None and field.type.kind in ("value", "list"):
        if effect.at or not row:
            yield f"{field.name} has several values, but {name} has one"
        elif name in _JOINT_ROWS and size != joints:
            yield f"{field.name} has {size} values, but the arm has {joints} joints"
    elif field is not None and row and not effect.at and name not in _AS_ONE[effect.verb]:
        yield f"{field.name} has one value, but {name} has several; `at` can choose one of them"


def _unlike(field: Field | None, state: State, at: Sequence[str], name: str) -> Iterator[str]:
    """Yield why a field and a state do not have the same kind of value."""
    if (field is None) != (state.type is None):
        text, other = (name, state.name) if field is None else (state.name, name)
        yield f"{text} is a text, but {other} is not"
    if field is None or state.type is None or field.selector:
        return
    row = len(at) == len(state.each) - 1
    mine, its = _units(field.type), _units(state.type)
    if set(mine) != set(its) or (len(mine) != len(its) and not row):
        yield f"{field.name} is {' '.join(mine)}, but the state {state.name} is {' '.join(its)}"


def _units(type: Type) -> list[str]:
    return [getattr(part, "unit", "") or "a number" for _, part in type.parts]


def _beyond(
    effect: Effect,
    arguments: Mapping[str, Field | None],
    state: State,
    types: Mapping[str, Type],
    chosen: str,
) -> Iterator[str]:
    """Yield the indices of a command that a state does not have.

    If ``at`` leaves out the last index, the field holds one value for each value of that index.
    """
    at = effect.at
    if len(state.each) - len(at) not in (0, 1):
        count = f"{len(state.each)} {'index' if len(state.each) == 1 else 'indices'}"
        yield f"{state.name} has {count}, but `at` names {len(at)} argument(s)"
        return
    if effect.verb == "sets":
        # A fixed value may also be set for every joint (254), or for one of another limb.
        return
    for name, each in zip(at, state.each):
        field, index = arguments.get(name), types.get(each)
        if index and field and name != chosen and not _inside(field.type, index):
            yield f"{name} goes beyond {each}, the index of {state.name}"
    last = types.get(state.each[-1]) if len(at) < len(state.each) else None
    if last and ends(last)[0] != 1:
        first = f"{last.name} starts at {ends(last)[0]}"
        yield f"a field with a value for each {last.name} needs indices from 1, but {first}"


def _inside(type: Type, index: Type) -> bool:
    (low, high), (least, most) = ends(type), ends(index)
    return least <= low and high <= most


def ends(type: Type) -> tuple[Fraction, Fraction]:
    """Return the lowest and the highest raw value of a type."""
    if isinstance(type, Quantity):
        return type.bounds
    values = [Fraction(member.value) for member in type.members] or [Fraction(0), Fraction(1)]
    return min(values), max(values)


RULES = (states_fit, no_contradictions, values_fit)
