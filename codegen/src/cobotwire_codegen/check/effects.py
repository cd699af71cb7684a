"""Rules for effects: they name state and fields that exist, and do not contradict each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

from cobotwire_codegen.build.effects import given, reported, states_named
from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.language.words import BUILT_IN, SETTABLE
from cobotwire_codegen.model import Command, Edition, Effect, Field, Quantity, State, Type
from cobotwire_codegen.publish_effects import plain

# The keys of an effect whose value is an argument that every request has.
ARGUMENTS = ("by", "about", "direction", "append", "from", "near")


# What decides a motion, by the part that moves; `speed` and `keeps` may be added.
_MOTIONS = {
    "joints": (("to",),),
    "joint": (("at", "to"), ("at", "by"), ("at", "until", "direction")),
    "end": (("to",), ("about", "to"), ("about", "by"), ("about", "until", "direction")),
    "gripper": (("to",),),
}
_LIST = ("append", "take", "clear", "report")
# The kinds of types of one number, and the keys whose argument has such a type.
_NUMBERS = ("quantity", "enum", "flag")
_SINGLE = ("by", "about", "direction")
# The built-in state that is true or false, and that which has a value for each joint or axis.
_SWITCHES = ("powered", "connected", "free", "held")
_JOINT_ROWS = ("angles", "planned_angles", "speeds", "held", "lowest", "highest")
_AXIS_ROWS = ("coords", "base_coords", "planned_coords")
# Those of them that one value can stand for: whether all are held, or a limit of all.
_AS_ONE = {"reports": ("held",), "stores": ("held", "lowest", "highest")}


def states_fit(edition: Edition) -> Iterator[Problem]:
    """Report states that hide a built-in one, unknown indices, and starts of the wrong type."""
    types = {type.name for type in edition.types}
    for state in edition.states:
        for each in state.each:
            if each not in types:
                message = f"{state.name} is for each {each}, which is no type{nearest(each, types)}"
                yield Problem(state.place, "unknown-type", message)
        if state.name in BUILT_IN:
            message = f"{state.name} is the arm's own state, which no edition declares"
            yield Problem(state.place, "bad-state", message)
        if state.start is None:
            continue
        wrong = _wrong_value(state.name, state, state.start)
        if wrong:
            yield Problem(state.place, "bad-start-value", f"start of {state.name}: {wrong}")


def _wrong_value(name: str, state: State | None, value: object) -> str:
    """Return why a state, which is built in if it is None, cannot have a value; else nothing."""
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


def effects_fit(edition: Edition) -> Iterator[Problem]:
    """Report effects that name an unknown state, field or case, or that no query may have."""
    states = {state.name: state for state in edition.states}
    for command in edition.commands:
        effect = command.effect
        if effect is not None and command.event:
            message = f"{command.name} is an event, which no request asks for, so it has no effect"
            yield Problem(effect.place, "bad-effect", message)
        elif effect is not None and not effect.by_role:
            for message in _wrong(effect, command, states):
                yield Problem(effect.place, "bad-effect", f"{message} (effect of {command.name})")


def _wrong(effect: Effect, command: Command, states: Mapping[str, State]) -> Iterator[str]:
    arguments, replied = given(command), reported(command)
    target = effect.option("to")
    needed = [*effect.at, *(str(v) for k, v in effect.options if k in ARGUMENTS)]
    needed += [target] if isinstance(target, str) else []
    needed += [effect.what] if effect.verb == "selector" else []
    fields = [name for name, _ in effect.values]
    others = [str(value) for key, value in effect.options if key == "speed"]
    others += fields if effect.verb == "stores" else []
    for name in (*needed, *others):
        if name not in arguments:
            yield f"{command.name} has no argument {name}{nearest(name, arguments)}"
        elif name in needed and _may_be_absent(name, command):
            yield f"{name} may be left out, so the effect cannot depend on it"
    for name in fields if effect.verb == "reports" else ():
        if name not in replied:
            yield f"the reply of {command.name} has no field {name}{nearest(name, replied)}"
    if len(set(effect.at)) < len(effect.at):
        yield "`at` names an argument twice"
    yield from _wrong_keys(effect)
    yield from _wrong_sizes(effect, command, arguments)
    yield from _unknown_states(effect, states)
    changes = effect.verb in ("stores", "sets", "moves", "zeroes", "does")
    if command.safety == "query" and (changes or any(map(effect.option, _LIST[:-1]))):
        yield f"a query changes nothing, so it cannot have the effect {effect.verb}"
    yield from _wrong_cases(effect, arguments.get(effect.what))
    for _, inner in effect.cases:
        yield from _wrong(inner, command, states)


def _may_be_absent(name: str, command: Command) -> bool:
    """Return whether a variant of the request lacks an argument; a text has all of its own."""
    return name not in command.text_arguments and any(
        all(field.name != name for field in variant) for variant in command.requests
    )


def _wrong_keys(effect: Effect) -> Iterator[str]:
    """Yield which keys of an effect are missing, or do not fit together."""
    keys = {name for name, _ in effect.options} | ({"at"} if effect.at else set())
    if effect.verb == "moves":
        ways = _MOTIONS[effect.what]
        if tuple(sorted(keys - {"speed", "keeps"})) not in map(tuple, map(sorted, ways)):
            yield f"`moves: {effect.what}` needs {' or '.join(map(_listed, ways))}, and no more"
        if "keeps" in keys and (effect.what != "end" or "until" not in keys):
            yield "only `moves: end` with `until` has the key `keeps`"
        if effect.what == "end" and "to" in keys and not isinstance(effect.option("to"), str):
            yield "`to` of `moves: end` must be an argument"
    elif effect.verb == "list":
        if len(keys & set(_LIST)) != 1:
            yield f"`list` needs exactly one of the keys {', '.join(_LIST)}"
        if "empty" in keys and "take" not in keys:
            yield "only `take` has the key `empty`"
    one = effect.what == "joint" or (effect.verb == "does" and effect.what == "halt" and effect.at)
    if effect.verb in ("moves", "zeroes", "does") and len(effect.at) != (1 if one else 0):
        most = "one argument" if one else "no argument"
        yield f"`at` of `{effect.verb}: {effect.what}` must name {most}"


def _wrong_sizes(
    effect: Effect, command: Command, arguments: Mapping[str, Field | None]
) -> Iterator[str]:
    """Yield which arguments are rows instead of single numbers, or the other way round."""
    options = {key: name for key, name in effect.options if isinstance(name, str)}
    rows = [options[key] for key in ("from", "near") if key in options]
    single = [*effect.at, *(options[key] for key in _SINGLE if key in options)]
    single += [effect.what] if effect.verb == "selector" else []
    # All joints have a row of targets, or the same one.
    if "to" in options and effect.what != "joints":
        (rows if effect.what == "end" and "about" not in options else single).append(options["to"])
    for name in (*rows, *single):
        field, kinds = arguments.get(name), ("value",) if name in rows else _NUMBERS
        if name in arguments and (field is None or field.type.kind not in kinds):
            yield f"{name} must be {'a row' if name in rows else 'a single number'}"
    if effect.verb == "computes":
        last = list(reported(command).values())[-1:]
        if not last or last[0] is None or last[0].type.kind != "value":
            yield "the last field of the reply must be a row, which is computed"


def _listed(keys: Sequence[str]) -> str:
    return " with ".join(f"`{key}`" for key in keys)


def _wrong_cases(effect: Effect, selector: Field | None) -> Iterator[str]:
    """Yield which cases are no value of their selector, or stand for the same one."""
    found: dict[int, str] = {}
    if not effect.cases or selector is None:
        return
    if selector.type.kind not in _NUMBERS:
        return
    members = {member.name: member.value for member in selector.type.members}
    low, high = _ends(selector.type)
    for case, _ in effect.cases:
        if case not in members and not case.lstrip("-").isdecimal():
            yield f"{selector.name} is never {case}{nearest(case, members)}"
            continue
        raw = members[case] if case in members else int(case)
        if not low <= raw <= high or (members and raw not in members.values()):
            yield f"{selector.name} is never {case}"
        if raw in found:
            yield f"the cases {found[raw]} and {case} are the same value of {selector.name}"
        found[raw] = case


def _unknown_states(effect: Effect, states: Mapping[str, State]) -> Iterator[str]:
    named = () if effect.cases else states_named(effect)
    for name in named:
        if name not in states and name not in BUILT_IN:
            yield f"there is no state {name}{nearest(name, [*states, *BUILT_IN])}"
        elif name in BUILT_IN and name not in SETTABLE and effect.verb in ("stores", "sets"):
            yield f"{name} follows from motion: no command sets it directly"
        elif name in BUILT_IN and effect.verb == "list":
            yield f"{name} is not a list: declare a state for it"
        elif effect.verb == "sets":
            yield from filter(
                None, [_wrong_value(name, states.get(name), dict(effect.values)[name])]
            )


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
        yield f"{name} has {'one index' if row else 'no index'}, but `at` names {len(effect.at)}"
    elif effect.verb != "sets" and field is None:
        yield f"{name} is not a text"
    elif field is not None and field.type.kind in ("value", "list"):
        if effect.at or not row:
            yield f"{field.name} is a row, but {name} is one value"
        elif name in _JOINT_ROWS and size != joints:
            yield f"{field.name} has {size} values, but the arm has {joints} joints"
    elif field is not None and row and not effect.at and name not in _AS_ONE[effect.verb]:
        yield f"{field.name} is one value, but {name} is a row; `at` can choose a value of it"


def _unlike(field: Field | None, state: State, at: Sequence[str], name: str) -> Iterator[str]:
    """Yield why a field and a state have not the same kind of value."""
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
    """Yield which index of a command a state does not have; a row runs along the last one."""
    at = effect.at
    if len(state.each) - len(at) not in (0, 1):
        count = f"{len(state.each)} {'index' if len(state.each) == 1 else 'indices'}"
        yield f"{state.name} has {count}, but `at` names {len(at)}"
        return
    if effect.verb == "sets":
        # A fixed value may also be set for every joint (254), or for one of another limb.
        return
    for name, each in zip(at, state.each):
        field, index = arguments.get(name), types.get(each)
        if index and field and name != chosen and not _inside(field.type, index):
            yield f"{name} goes beyond {each}, the index of {state.name}"
    last = types.get(state.each[-1]) if len(at) < len(state.each) else None
    if last and _ends(last)[0] != 1:
        yield f"a row begins with index 1, but {last.name} with {_ends(last)[0]}"


def _inside(type: Type, index: Type) -> bool:
    (low, high), (least, most) = _ends(type), _ends(index)
    return least <= low and high <= most


def _ends(type: Type) -> tuple[Fraction, Fraction]:
    if isinstance(type, Quantity):
        return type.bounds
    values = [Fraction(member.value) for member in type.members] or [Fraction(0), Fraction(1)]
    return min(values), max(values)


RULES = (states_fit, effects_fit, no_contradictions, values_fit)
