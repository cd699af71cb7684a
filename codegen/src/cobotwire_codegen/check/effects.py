"""Rules for effects: they name state and fields that exist, and do not contradict each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from cobotwire_codegen.build.effects import given, reported, states_named
from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.language.words import BUILT_IN, SETTABLE
from cobotwire_codegen.model import Command, Edition, Effect, Field, Quantity, State, Type
from cobotwire_codegen.publish_effects import plain

# The keys of an effect whose value is an argument.
ARGUMENTS = ("by", "about", "direction", "speed", "append", "from", "near")


def states_fit(edition: Edition) -> Iterator[Problem]:
    """Report states that hide a built-in one, and starts that their type does not allow."""
    for state in edition.states:
        if state.name in BUILT_IN:
            message = f"{state.name} is the arm's own state, which no edition declares"
            yield Problem(state.place, "bad-state", message)
        if state.start is None:
            continue
        try:
            plain(state.type, state.name, state.start)
        except ValueError as error:
            yield Problem(state.place, "bad-start-value", f"start of {state.name}: {error}")


def effects_fit(edition: Edition) -> Iterator[Problem]:
    """Report effects that name an unknown state, field or case, or that no query may have."""
    states = {state.name: state for state in edition.states}
    for command in edition.commands:
        effect = command.effect
        if effect is not None and not effect.by_role:
            for message in _wrong(effect, command, states):
                yield Problem(effect.place, "bad-effect", f"{message} (effect of {command.name})")


def _wrong(effect: Effect, command: Command, states: Mapping[str, State]) -> Iterator[str]:
    arguments, replied = given(command), reported(command)
    wanted = [*effect.at, *(str(v) for k, v in effect.options if k in ARGUMENTS)]
    target = effect.option("to")
    wanted += [target] if isinstance(target, str) else []
    fields = [name for name, _ in effect.values]
    wanted += fields if effect.verb == "stores" else []
    wanted += [effect.what] if effect.verb == "selector" else []
    for name in wanted:
        if name not in arguments:
            yield f"{command.name} has no argument {name}{nearest(name, arguments)}"
    for name in fields if effect.verb == "reports" else ():
        if name not in replied:
            yield f"the reply of {command.name} has no field {name}{nearest(name, replied)}"
    yield from _unknown_states(effect, states)
    if command.safety == "query" and effect.verb in ("stores", "sets", "moves", "zeroes", "does"):
        yield f"a query changes nothing, so it cannot have the effect {effect.verb}"
    for _, inner in effect.cases:
        yield from _wrong(inner, command, states)


def _unknown_states(effect: Effect, states: Mapping[str, State]) -> Iterator[str]:
    named = () if effect.cases else states_named(effect)
    for name in named:
        if name not in states and name not in BUILT_IN:
            yield f"there is no state {name}{nearest(name, [*states, *BUILT_IN])}"
        elif name in BUILT_IN and name not in SETTABLE and effect.verb in ("stores", "sets"):
            yield f"{name} follows from motion: no command sets it directly"
    for name, value in effect.values if effect.verb == "sets" else ():
        state = states.get(name)
        try:
            plain(state.type if state else None, name, value)
        except ValueError as error:
            yield str(error)


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


# The state that begins as the servos of the edition say.
REGISTERS = "registers"


def _changed(effect: Effect) -> list[str]:
    """Return the states that an effect gives a value; only code knows which it gives more."""
    if effect.verb == "list":
        return [effect.what]
    values = effect.values
    names = {"stores": [str(state) for _, state in values], "sets": [name for name, _ in values]}
    return names.get(effect.verb, [])


def _reported_states(effect: Effect) -> list[str]:
    return [str(state) for _, state in effect.values] if effect.verb == "reports" else []


def values_fit(edition: Edition) -> Iterator[Problem]:
    """Report fields whose values a state cannot have, and indices that it lacks."""
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
    if effect is None or effect.verb not in ("reports", "stores"):
        return
    states = {state.name: state for state in edition.states}
    fields = reported(command) if effect.verb == "reports" else given(command)
    for name, target in effect.values:
        state = states.get(str(target))
        if state is not None:
            yield from _unlike(fields.get(name), state, effect.at)
            yield from _beyond(effect.at, given(command), state, types, chosen)


def _unlike(field: Field | None, state: State, at: Sequence[str]) -> Iterator[str]:
    """Yield why a field and a state have not the same kind of value."""
    if field is None or state.type is None or field.selector:
        return
    row = len(at) == len(state.each) - 1
    mine, its = _units(field.type), _units(state.type)
    if set(mine) != set(its) or (len(mine) != len(its) and not row):
        yield f"{field.name} is {' '.join(mine)}, but the state {state.name} is {' '.join(its)}"


def _units(type: Type) -> list[str]:
    return [getattr(part, "unit", "") or "a number" for _, part in type.parts]


def _beyond(
    at: Sequence[str],
    arguments: Mapping[str, Field | None],
    state: State,
    types: Mapping[str, Type],
    chosen: str,
) -> Iterator[str]:
    """Yield which index of a command a state does not have; a row runs along the last one."""
    if len(state.each) - len(at) not in (0, 1):
        yield f"{state.name} has {len(state.each)} indices, but `at` names {len(at)}"
        return
    for name, each in zip(at, state.each):
        field, index = arguments.get(name), types.get(each)
        if index is None:
            yield f"{state.name} is for each {each}, which is no type{nearest(each, types)}"
        elif field is not None and name != chosen and not _inside(field.type, index):
            yield f"{name} goes beyond {each}, the index of {state.name}"


def _inside(type: Type, index: Type) -> bool:
    (low, high), (least, most) = _ends(type), _ends(index)
    return least <= low and high <= most


def _ends(type: Type) -> tuple[Fraction, Fraction]:
    if isinstance(type, Quantity):
        return type.bounds
    values = [Fraction(member.value) for member in type.members] or [Fraction(0), Fraction(1)]
    return min(values), max(values)


RULES = (states_fit, effects_fit, no_contradictions, values_fit)
