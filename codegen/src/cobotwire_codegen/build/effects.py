"""Builds the state of an edition, and the effects of its commands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import Any

from cobotwire_codegen import language
from cobotwire_codegen.build.parts import Parts
from cobotwire_codegen.build.types import Types
from cobotwire_codegen.build.vectors import plain_value
from cobotwire_codegen.errors import Place, Problem, nearest
from cobotwire_codegen.language.effects import ByCase, Reports, State, Stores
from cobotwire_codegen.language.names import LOWER
from cobotwire_codegen.language.records import Key, Named
from cobotwire_codegen.language.shapes import Name, check_name
from cobotwire_codegen.load import Mapping, Node, Scalar, Sequence
from cobotwire_codegen.model import Command, Effect, Field
from cobotwire_codegen.model import State as KeptState
from cobotwire_codegen.model.commands import named_fields
from cobotwire_codegen.reader import Reader

# Keys that effects of several kinds may have. Of the others, one is the verb (such as `stores`),
# which states the kind and holds the subject; the rest are the verb's options.
_COMMON = ("at", "assumed")


def build_state(
    parts: Parts, types: Types, commands: Iterable[Command], problems: list[Problem]
) -> tuple[KeptState, ...]:
    """Return the state of an arm, without state that only commands of the base used."""
    used = {name for command in commands for name in states_named(command.effect)}
    return tuple(
        _state(name, stated, types, problems)
        for name, stated in parts.state.items()
        if name in used or name in parts.own_state
    )


def states_named(effect: Effect | None) -> Iterator[str]:
    """Yield the states that an effect names."""
    if effect is None:
        return
    if effect.verb == "list":
        yield effect.what
    for name, value in effect.values:
        yield name if effect.verb == "sets" else str(value)
    for _, inner in effect.cases:
        yield from states_named(inner)


def _state(
    name: str, stated: tuple[Place, Node], types: Types, problems: list[Problem]
) -> KeptState:
    place, node = stated
    reader = Reader(node, State, f"the state {name}", problems)
    of = reader.get(State.type)
    type = types.find(of, reader.place_of(State.type)) if of else None
    return KeptState(
        place, name, type, reader.get(State.each), _plain(reader, State.start, bool, tuple)
    )


def build_effect(node: Node | None, command: Command, problems: list[Problem]) -> Effect | None:
    """Return the effect of a command: as stated, or as its role implies.

    None if neither is the case.
    """
    implied = _of_role(command)
    if node is None:
        return implied
    what = f"the effect of {command.name}"
    if implied is not None:
        message = f"the role {command.role} of {command.name} already states what the command does"
        problems.append(Problem(node.place, "bad-effect", message))
        return implied
    return _effect(node, command, what, problems)


def _effect(node: Node, command: Command, what: str, problems: list[Problem]) -> Effect | None:
    choice = language.ANY_EFFECT
    if isinstance(node, Mapping):
        verbs = choice.present(node)
        if len(verbs) != 1:
            hints = (nearest(key, choice.chosen) for key in node.entries if not verbs)
            hint = next((hint for hint in hints if "did you mean" in hint), "")
            message = f"{what} must have exactly one of the keys {', '.join(choice.chosen)}{hint}"
            problems.append(Problem(node.place, "bad-effect", message))
            return None
    reader = Reader(node, choice, what, problems)
    if not isinstance(node, Mapping):
        return None
    [verb] = verbs
    return _of_verb(verb, reader, command, problems)


def _of_verb(verb: str, reader: Reader, command: Command, problems: list[Problem]) -> Effect | None:
    record, keys = reader.record, reader.record.keys()
    at = reader.get(keys["at"]) if "at" in keys else ()
    assumed = reader.get(keys["assumed"]) if "assumed" in keys else ""
    options = tuple(
        (name, _plain(reader, key))
        for name, key in keys.items()
        if name not in (verb, *_COMMON, "cases") and reader.node(key) is not None
    )
    subject = reader.get(keys[verb])
    if record is ByCase:
        cases = [
            (name, _effect(inner, command, f"the case {name} of {reader.what}", problems))
            for name, _, inner in reader.get(ByCase.cases)
        ]
        made = tuple((name, effect) for name, effect in cases if effect is not None)
        return Effect(reader.place, verb, subject, cases=made)
    if record in (Reports, Stores):
        values: tuple[tuple[str, object], ...] = _pairs(subject, at, reader, command, verb)
        return Effect(reader.place, verb, "", values, at, options, (), assumed)
    if verb == "sets":
        stated = tuple((name, plain_value(value)) for name, _, value in subject)
        return Effect(reader.place, verb, "", stated, at, options, (), assumed)
    return Effect(reader.place, verb, subject, (), at, options, (), assumed)


def _plain(reader: Reader, key: Key[Any], *others: type) -> object:
    """Return the value of a key: a word or a number, or a value of the other types."""
    read = reader.get(key)
    if not isinstance(read, Scalar | Sequence | Mapping):
        return read
    value = plain_value(read)
    if type(value) in (int, Fraction, str, *others):
        return value
    message = f"{key.name} of {reader.what} must be {key.shape.words}"
    reader.problem("wrong-kind", message, read.place)
    return None


def _pairs(
    node: Node, at: Iterable[str], reader: Reader, command: Command, verb: str
) -> tuple[tuple[str, object], ...]:
    """Return pairs of a field and its state.

    If the spec names only a state, pair it with the single field that can hold it.
    """
    if isinstance(node, Mapping):
        values = Named(Name(LOWER), LOWER, ("empty-list", "name a state"))
        named = values.read(node, f"{verb} of {reader.what}", reader.problem)
        subject = f"a state in {verb} of {reader.what}"
        return tuple(
            (name, Name(LOWER).read(inner, subject, reader.problem)) for name, _, inner in named
        )
    if isinstance(node, Scalar) and isinstance(node.value, str):
        check_name(node.value, LOWER, node.place, reader.problem)
        fields = reported(command) if verb == "reports" else given(command)
        names = [name for name in fields if name not in at]
        if len(names) == 1:
            return ((names[0], node.value),)
        shown = f"the fields {', '.join(names)}" if names else "no field for a state"
        side = "the reply" if verb == "reports" else "the request"
        message = f"{verb} of {reader.what} must map fields to states, since {side} has {shown}"
        reader.problem("bad-effect", message, node.place)
        return ()
    message = f"{verb} of {reader.what} must be a state, or a mapping from fields to states"
    reader.problem("wrong-kind", message, node.place)
    return ()


def reported(command: Command) -> dict[str, Field | None]:
    """Return the fields of a reply that report something: no constants, counts or echoes.

    If several variants have a field of that name, it is the field of the first variant, the full
    one. The fields of a text reply have no type, so they map to None.
    """
    text = command.text.fields if command.text is not None else ()
    fields = (field for variant in reversed(command.replies) for field in variant)
    return {name: None for name, _ in text} | {
        field.name: field
        for field in fields
        if not (field.echo or field.counts or field.const is not None or field.selector)
    }


def given(command: Command) -> dict[str, Field | None]:
    """Return the arguments of a command; those of its text have no type, so they map to None."""
    found: dict[str, Field | None] = {
        name: fields[0] for name, fields in named_fields(command.requests).items()
    }
    return found | dict.fromkeys(command.text_arguments)


# What the reply of each role reports.
_REPORTED = {
    "joints": "angles",
    "coordinates": "coords",
    "reached": "reached",
    "moving": "moving",
    "powered": "powered",
    "paused": "paused",
    "error": "error",
}
_MOVED = {
    "joint targets": "joints",
    "joint target": "joint",
    "coordinate targets": "end",
    "coordinate target": "end",
}


def _of_role(command: Command) -> Effect | None:
    """Return the effect that a role implies.

    None if the role implies none, or the command has no role.
    """
    state, part = _REPORTED.get(command.role), _MOVED.get(command.role)
    if command.role == "stop":
        return Effect(command.place, "does", "stop", by_role=True)
    if state is not None and command.replies and command.replies[0]:
        field = command.replies[0][-1].name
        return Effect(command.place, "reports", values=((field, state),), by_role=True)
    if part is None or not command.requests or not command.requests[0]:
        return None
    variant = command.requests[0]
    speeds = [
        f.name
        for f in variant
        if f.type.kind == "quantity" and f.type.parts[0][1].unit == "percent"
    ]
    speed: tuple[tuple[str, object], ...] = tuple(("speed", name) for name in speeds[:1])
    rest = [field for field in variant if field.name not in speeds[:1]]
    if command.role.endswith("s"):
        rows = [field.name for field in rest if field.type.kind == "value"]
        options = (("to", rows[0]), *speed) if rows else speed
        return Effect(command.place, "moves", part, options=options, by_role=True)
    target = next((f for f in rest if f.selector), None) or next(
        (f for f in rest if _has_unit(f)), None
    )
    picker = next((f.name for f in rest if f is not target), "")
    if target is None or not picker:
        return None
    options = (("to", target.name), *speed)
    if part == "end":
        return Effect(
            command.place, "moves", part, options=(*options, ("about", picker)), by_role=True
        )
    return Effect(command.place, "moves", part, at=(picker,), options=options, by_role=True)


def _has_unit(field: Field) -> bool:
    return field.type.kind == "quantity" and (
        bool(field.type.parts[0][1].unit) or field.type.parts[0][1].scale != 1
    )
