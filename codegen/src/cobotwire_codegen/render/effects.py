"""What a command does, in words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cobotwire_codegen.language.words import CONTROLS
from cobotwire_codegen.model import Command, Edition, Effect

_PARTS = {"joints": "all joints", "joint": "a joint", "end": "the end", "gripper": "the gripper"}


def effect_in_words(edition: Edition, command: Command) -> str:
    """Return sentences that say what a command does, with the commands that show or set it."""
    effect = command.effect
    if effect is None:
        return ""
    words = [*_sentences(effect), *_others(edition, command, effect)]
    if effect.assumed:
        words.append(f"No source states this effect: {_sentence(effect.assumed)}")
    return " ".join(words)


def _sentences(effect: Effect) -> Iterator[str]:
    match effect.verb:
        case "reports":
            yield f"It reports {_names(str(state) for _, state in effect.values)}{_of(effect)}."
        case "stores":
            yield f"It sets {_names(str(state) for _, state in effect.values)}{_of(effect)}."
        case "sets":
            shown = (f"{_name(name)} to {_value(value)}" for name, value in effect.values)
            yield f"It sets {_listed(shown)}{_of(effect)}."
        case "moves":
            yield f"It moves {_PARTS[effect.what]}{_way(effect)}."
        case "zeroes":
            yield f"The present position of {_PARTS[effect.what]} becomes its zero."
        case "does":
            yield CONTROLS[effect.what]
        case "list":
            yield _list(effect)
        case "computes":
            yield f"It computes {_name(effect.what)}; nothing changes."
        case "unknown":
            yield f"No source says what it does: {_sentence(effect.what)}"
        case "python":
            yield _sentence(effect.what)
        case _:
            for case, inner in effect.cases:
                for sentence in _sentences(inner):
                    yield f"`{effect.what}` {case}: {sentence[0].lower()}{sentence[1:]}"


def _way(effect: Effect) -> str:
    if effect.option("until"):
        return " until it is stopped, or at a limit"
    if effect.option("by"):
        return " by a distance"
    target = effect.option("to")
    return " to a target" if isinstance(target, str) or target is None else f" to {_value(target)}"


def _list(effect: Effect) -> str:
    name = _name(effect.what)
    if effect.option("append"):
        return f"It adds a value to {name}."
    if effect.option("take"):
        return f"It reports the first value of {name}, and removes it."
    if effect.option("clear"):
        return f"It empties {name}."
    return f"It reports how many values {name} has."


def _others(edition: Edition, command: Command, effect: Effect) -> Iterator[str]:
    """Yield which query reports what the command sets, or which commands set what it reports."""
    if command.read_by is not None:
        yield f"`{command.read_by.query}` reports it."
    elif effect.verb in ("stores", "sets"):
        yield "No query reports it."
    if effect.verb in ("reports", "list") and command.safety == "query":
        setters = [
            f"`{c.name}`"
            for c in edition.commands
            if c.read_by is not None and c.read_by.query == command.name
        ]
        if setters:
            yield f"{_listed(setters)} {'sets' if len(setters) == 1 else 'set'} it."
    if command.safety == "persistent write" and effect.verb in ("stores", "sets"):
        yield "It survives a power cycle."


def _of(effect: Effect) -> str:
    return f" of one {_listed(_name(name) for name in effect.at)}" if effect.at else ""


def _name(state: str) -> str:
    return state.replace("_", " ")


def _names(states: Iterable[str]) -> str:
    return _listed(dict.fromkeys(map(_name, states)))


def _listed(words: Iterable[str]) -> str:
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last


def _value(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _sentence(text: str) -> str:
    return text if text.endswith(".") else f"{text}."
