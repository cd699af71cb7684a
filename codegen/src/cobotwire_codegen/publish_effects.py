"""Publish the state of an edition and the effects of its commands, as parts of ``edition.json``."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from cobotwire_codegen.model import Command, Edition, Effect, State, Type
from cobotwire_codegen.publish_sections import exact_number
from cobotwire_codegen.wire import raw_values

Record = dict[str, Any]


def published_states(edition: Edition) -> Record:
    """Return the state of an edition by name: its indices, and its value at the start."""
    found = {}
    for state in edition.states:
        record: Record = {}
        if state.type is not None:
            record |= {"type": state.type.name, "kind": state.type.kind}
            record["size"] = len(state.type.parts)
        if state.each:
            record["each"] = list(state.each)
        if state.start is not None:
            record["start"] = _exact(plain(state.type, state.name, state.start), state)
        found[state.name] = record
    return found


def published_effect(effect: Effect, command: Command, states: Mapping[str, State]) -> Record:
    """Return an effect as the spec states it, with every short form written out."""
    record: Record = {effect.verb: effect.what}
    if effect.verb in ("reports", "stores"):
        record = {effect.verb: dict(effect.values)}
    elif effect.verb == "sets":
        types = {name: state.type for name, state in states.items()}
        record = {
            "sets": {name: plain(types.get(name), name, value) for name, value in effect.values}
        }
    if effect.at:
        record["at"] = list(effect.at)
    record |= {name: _number(value) for name, value in effect.options}
    if effect.cases:
        record["cases"] = {
            str(_raw(effect.what, name, command)): published_effect(inner, command, states)
            for name, inner in effect.cases
        }
    if effect.assumed:
        record["assumed"] = effect.assumed
    return record


def _raw(selector: str, case: str, command: Command) -> int:
    """Return the raw value of a case, which is a member of the selector or a number."""
    fields = (field for variant in command.requests for field in variant)
    members = {m.name: m.value for f in fields if f.name == selector for m in f.type.members}
    return members[case] if case in members else int(case)


def plain(type: Type | None, name: str, value: object) -> Any:
    """Return a physical value as JSON.

    Raises:
        ValueError: the type does not allow the value.
    """
    if type is None:
        return _number(value)
    if type.kind in ("bits", "bytes", "text", "list"):
        raise ValueError(f"{name} is neither a number nor several numbers")
    raws = raw_values(type, name, value)
    if type.kind == "enum":
        return raws[0]
    return bool(raws[0]) if type.kind == "flag" else _number(value)


def _exact(value: Any, state: State) -> Any:
    """Return a start value as JSON, with exact numbers like the rest of the document."""
    stated = state.start
    if isinstance(stated, tuple):
        return [exact_number(Fraction(part)) for part in stated]
    return exact_number(stated) if isinstance(stated, Fraction) else value


def _number(value: object) -> Any:
    """Return a number, a word or a list of them as JSON."""
    if isinstance(value, tuple):
        return [_number(item) for item in value]
    return float(value) if isinstance(value, Fraction) else value
