"""Rules for effects: their keys belong together, and name state and fields that exist."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from cobotwire_codegen.build.effects import given, reported, states_named
from cobotwire_codegen.check.states import ends, wrong_value
from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.language.words import BUILT_IN, SETTABLE
from cobotwire_codegen.model import Command, Edition, Effect, Field, State

# The keys of an effect that name an argument; every request must have it.
ARGUMENTS = ("by", "about", "direction", "append", "from", "near")


# The keys that a motion needs, by the part that moves; `speed` and `keeps` may be added.
_MOTIONS = {
    "joints": (("to",),),
    "joint": (("at", "to"), ("at", "by"), ("at", "until", "direction")),
    "end": (("to",), ("about", "to"), ("about", "by"), ("about", "until", "direction")),
    "gripper": (("to",),),
}
_LIST = ("append", "take", "clear", "report")
# The kinds of types that have one number, and the keys that name an argument of these kinds.
_NUMBERS = ("quantity", "enum", "flag")
_SINGLE = ("by", "about", "direction")


def effects_fit(edition: Edition) -> Iterator[Problem]:
    """Report effects that name an unknown state, field or case, or that change state in a query."""
    states = {state.name: state for state in edition.states}
    for command in edition.commands:
        effect = command.effect
        if effect is not None and command.event:
            message = f"{command.name} is an event: without a request it has no effect"
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
    """Return whether a variant of the request lacks an argument, unless it is one of the text."""
    return name not in command.text_arguments and any(
        all(field.name != name for field in variant) for variant in command.requests
    )


def _wrong_keys(effect: Effect) -> Iterator[str]:
    """Yield which keys of an effect are missing, or do not fit together."""
    keys = {name for name, _ in effect.options} | ({"at"} if effect.at else set())
    if effect.verb == "moves":
        allowed = _MOTIONS[effect.what]
        if tuple(sorted(keys - {"speed", "keeps"})) not in map(tuple, map(sorted, allowed)):
            yield f"`moves: {effect.what}` needs exactly {' or '.join(map(_listed, allowed))}"
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
    """Yield arguments that are value types but should be single numbers, or the reverse."""
    options = {key: name for key, name in effect.options if isinstance(name, str)}
    rows = [options[key] for key in ("from", "near") if key in options]
    single = [*effect.at, *(options[key] for key in _SINGLE if key in options)]
    single += [effect.what] if effect.verb == "selector" else []
    # The target of all joints may be a value type, or one number for all.
    if "to" in options and effect.what != "joints":
        (rows if effect.what == "end" and "about" not in options else single).append(options["to"])
    for name in (*rows, *single):
        field, kinds = arguments.get(name), ("value",) if name in rows else _NUMBERS
        if name in arguments and (field is None or field.type.kind not in kinds):
            yield f"{name} must be a {'value type' if name in rows else 'single number'}"
    if effect.verb == "computes":
        last = list(reported(command).values())[-1:]
        if not last or last[0] is None or last[0].type.kind != "value":
            yield "the last field of the reply holds what is computed; it must be a value type"


def _listed(keys: Sequence[str]) -> str:
    return " with ".join(f"`{key}`" for key in keys)


def _wrong_cases(effect: Effect, selector: Field | None) -> Iterator[str]:
    """Describe cases that are not a value of their selector, or are the same value as another."""
    found: dict[int, str] = {}
    if not effect.cases or selector is None:
        return
    if selector.type.kind not in _NUMBERS:
        return
    members = {member.name: member.value for member in selector.type.members}
    low, high = ends(selector.type)
    for case, _ in effect.cases:
        if case not in members and not case.lstrip("-").isdecimal():
            yield f"{selector.name} is never {case}{nearest(case, members)}"
            continue
        raw = members[case] if case in members else int(case)
        if not low <= raw <= high or (members and raw not in members.values()):
            yield f"{selector.name} is never {case}"
        if raw in found:
            yield f"the cases {found[raw]} and {case} mean the same value of {selector.name}"
        found[raw] = case
    for name, raw in members.items():
        if raw not in found:
            what = f"{name} of {selector.name} has no case"
            yield f"{what}; if its effect is not known, write {{unknown: why}}"


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
                None, [wrong_value(name, states.get(name), dict(effect.values)[name])]
            )


RULES = (effects_fit,)
