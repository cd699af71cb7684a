"""What a command does, in words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set

from cobotwire_codegen.language.words import CONTROLS
from cobotwire_codegen.model import Command, Edition, Effect

_PARTS = {
    "joints": "all joints",
    "joint": "one joint",
    "end": "the end of the arm",
    "gripper": "the gripper",
}
# The built-in state. Other state is called by its name.
_BUILT_IN = {
    "angles": "the angles of all joints",
    "coords": "the coordinates of the end of the arm",
    "base_coords": "the coordinates of the end of the arm in the frame of the base",
    "planned_angles": "the angles at which the present motion ends",
    "planned_coords": "the coordinates at which the present motion ends",
    "opening": "the opening of the gripper",
    "speeds": "how fast the joints turn",
    "moving": "whether the arm moves",
    "gripper_moving": "whether the gripper moves",
    "reached": "whether the arm is at the target",
    "powered": "whether the motors have power",
    "held": "whether all joints have torque",
    "free": "whether free mode is on",
    "paused": "whether the motion is paused",
    "connected": "whether the controller at the end of the arm is connected",
    "error": "the code of the last error",
    "lowest": "the smallest allowed angle of each joint",
    "highest": "the largest allowed angle of each joint",
    "starts": "how often the controller has started",
}
# The same words for one joint or axis.
_ONE = {
    "angles": "the angle",
    "coords": "the coordinate",
    "base_coords": "the coordinate in the frame of the base",
    "held": "whether there is torque",
    "lowest": "the smallest allowed angle",
    "highest": "the largest allowed angle",
}
# What can be switched on and off.
_SWITCHED = {
    "powered": "the power of the motors",
    "held": "the torque of the joints",
    "free": "free mode",
    "connected": "the controller at the end of the arm",
}
_ONE_SWITCHED = {"held": "the torque"}


def effect_in_words(edition: Edition, command: Command) -> str:
    """Return sentences that say what a command does, with the commands that show or set it."""
    effect = command.effect
    if effect is None:
        return ""
    types = {state.name: state.type for state in edition.states if not state.each}
    flags = {name for name, type in types.items() if type and type.kind == "flag"}
    words = [*_sentences(effect, flags), *_others(edition, command, effect)]
    if effect.assumed:
        words.append(f"This effect is assumed. {_sentence(effect.assumed)}")
    return " ".join(words)


def _sentences(effect: Effect, flags: Set[str]) -> Iterator[str]:
    match effect.verb:
        case "reports":
            yield f"It reports {_states(effect, flags)}."
        case "stores":
            yield f"It sets {_states(effect, flags)}."
        case "sets":
            yield f"It {', and '.join(_fixed(effect, flags))}{_chosen(effect.at)}."
        case "moves":
            moves = "turns" if effect.option("keeps") else "moves"
            yield f"It {moves} {_PARTS[effect.what]}{_way(effect)}."
        case "zeroes":
            yield f"The present position of {_PARTS[effect.what]} becomes its zero."
        case "does":
            yield CONTROLS[effect.what]
        case "list":
            yield _list(effect)
        case "computes":
            what, source = _state(effect, effect.what, flags), effect.option("from")
            yield f"It computes {what} from `{source}`; nothing changes."
        case "unknown" | "python":
            yield _sentence(effect.what)
        case _:
            for case, inner in effect.cases:
                for sentence in _sentences(inner, flags):
                    yield f"`{effect.what}` {case}: {sentence[0].lower()}{sentence[1:]}"


def _fixed(effect: Effect, flags: Set[str]) -> Iterator[str]:
    """Yield what a command sets to fixed values: what it switches on and off, and the rest."""
    nouns = _SWITCHED | (_ONE_SWITCHED if effect.at else {})
    for way, value in (("on", True), ("off", False)):
        switched = [nouns[name] for name, each in effect.values if each is value and name in nouns]
        if switched:
            yield f"switches {way} {_listed(switched)}"
    rest = [
        f"{_state(effect, name, flags)} to {_value(value)}{' percent' if name == 'opening' else ''}"
        for name, value in effect.values
        if name not in nouns
    ]
    if rest:
        yield f"sets {_listed(rest)}"


def _way(effect: Effect) -> str:
    """Return the target, distance or duration of a motion, and its axis."""
    about = effect.option("about")
    axis = _chosen((str(about),)) if about else ""
    if effect.option("until"):
        return f"{axis} until a limit is reached or another command stops the motion"
    for key in ("by", "to"):
        target = effect.option(key)
        if target is not None:
            unit = " percent" if effect.what == "gripper" else ""
            shown = f"`{target}`" if isinstance(target, str) else f"{target}{unit}"
            return f" {key} {shown}{axis}"
    return ""


def _list(effect: Effect) -> str:
    name = _words(effect.what)
    if effect.option("append"):
        return f"It adds `{effect.option('append')}` to the {name}."
    if effect.option("take"):
        return f"It reports the first of the {name}, and removes it."
    if effect.option("clear"):
        return f"It removes all {name}."
    if effect.option("report") == "empty":
        return f"It reports whether there are no {name}."
    return f"It reports the number of {name}."


def _others(edition: Edition, command: Command, effect: Effect) -> Iterator[str]:
    """Yield sentences: which query reports the effect, or which commands change what it reads."""
    if command.read_by is not None:
        yield f"`{command.read_by.query}` reports the result."
    elif effect.verb in ("stores", "sets"):
        yield "No query reports the result."
    if effect.verb in ("reports", "list") and command.safety == "query":
        setters = [
            f"`{c.name}`"
            for c in edition.commands
            if c.read_by is not None and c.read_by.query == command.name
        ]
        if setters:
            yield f"{_listed(setters)} {'changes' if len(setters) == 1 else 'change'} this."
    if command.safety == "persistent write" and effect.verb in ("stores", "sets"):
        yield "The result survives a power cycle."


def _states(effect: Effect, flags: Set[str]) -> str:
    states = dict.fromkeys(_state(effect, str(state), flags) for _, state in effect.values)
    return _listed(states) + _chosen(effect.at)


def _state(effect: Effect, name: str, flags: Set[str]) -> str:
    named = f"`{name}`" if name in flags else f"the {_words(name)}"
    return (_ONE if effect.at else {}).get(name) or _BUILT_IN.get(name) or named


def _chosen(arguments: Iterable[str]) -> str:
    shown = [f"`{name}`" for name in arguments]
    return f" for the given {_listed(shown)}" if shown else ""


def _words(state: str) -> str:
    return state.replace("_", " ")


def _listed(words: Iterable[str]) -> str:
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last


def _value(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _sentence(text: str) -> str:
    return text if text.endswith(".") else f"{text}."
