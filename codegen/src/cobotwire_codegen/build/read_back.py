"""Derives the query that reads back what a command set, from their effects; builds ``samples``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from cobotwire_codegen import language
from cobotwire_codegen.build.effects import given, reported
from cobotwire_codegen.language.number_shapes import Numbers
from cobotwire_codegen.language.records import entries_of
from cobotwire_codegen.language.shapes import items_of
from cobotwire_codegen.load import Node
from cobotwire_codegen.model import Command, Effect, Family, Field, ReadBack, Samples, Type
from cobotwire_codegen.reader import Reader
from cobotwire_codegen.wire import raw_values

# The state that a motion changes, by the part that moves.
MOVED = {"joints": "angles", "joint": "angles", "end": "coords", "gripper": "opening"}
# The value that each of these commands gives to the state `paused`.
_CONTROLLED = {"pause": True, "resume": False}


class _Written(NamedTuple):
    """The value that a command stores in a state: an argument, or a fixed value."""

    state: str
    argument: str = ""
    value: object = None


def with_read_back(families: Sequence[Family], encoder_zero: int | None) -> tuple[Family, ...]:
    """Return the families, each command with the query that reads back what it has set.

    Args:
        families: the families.
        encoder_zero: what the encoder of a joint reads at zero; None: not stated.
    """
    queries = [c for family in families for c in family.commands if c.safety == "query"]
    found = []
    for family in families:
        # If several queries report the same state, prefer those of the command's own family.
        near = sorted(queries, key=lambda query: query not in family.commands)
        commands = (replace(c, read_by=_read_back(c, near, encoder_zero)) for c in family.commands)
        found.append(replace(family, commands=tuple(commands)))
    return tuple(found)


def _read_back(
    command: Command, queries: Sequence[Command], encoder_zero: int | None
) -> ReadBack | None:
    effect = command.effect
    if effect is None or effect.assumed or command.safety == "query":
        return None
    written = tuple(_written(effect))
    for at in dict.fromkeys((effect.at, ())):
        found = []
        for query in queries:
            query_effect = query.effect
            if query_effect is None or query_effect.assumed or query_effect.at != at:
                continue
            pairs = tuple(_pairs(written, command, query, query_effect, encoder_zero))
            # A query without an index can only confirm fixed values.
            if pairs and (at == effect.at or all(isinstance(raw, int) for _, raw in pairs)):
                found.append((len(reported(query)) - len(pairs), query, pairs))
        if found:
            # Choose the query that reports the fewest other values.
            _, query, pairs = min(found, key=lambda each: each[0])
            return ReadBack(effect.place, query.name, _short(pairs, command, query))
    return None


def _short(
    pairs: tuple[tuple[str, str | int], ...], command: Command, query: Command
) -> tuple[tuple[str, str | int], ...]:
    """Return the pairs, or () for the default: each shared name is paired with itself."""
    shared = reported(query).keys() & given(command).keys()
    same = {name for name, source in pairs if name == source}
    return () if len(same) == len(pairs) and same == shared else pairs


def _written(effect: Effect) -> Iterator[_Written]:
    """Yield what a command writes, as far as it is the same for every call."""
    match effect.verb:
        case "stores":
            yield from (_Written(str(state), argument) for argument, state in effect.values)
        case "sets":
            yield from (_Written(state, "", value) for state, value in effect.values)
        case "moves":
            target = effect.option("to")
            if isinstance(target, str) and effect.option("about") is None:
                yield _Written(MOVED[effect.what], target)
        case "zeroes":
            yield _Written("opening" if effect.what == "gripper" else "angles", "", 0)
        case "does" if effect.what in _CONTROLLED:
            yield _Written("paused", "", _CONTROLLED[effect.what])
        case "list" if effect.option("clear"):
            yield _Written(effect.what, "", 0)
        case "selector" if effect.cases:
            # What every case writes.
            first, *rest = (tuple(_written(inner)) for _, inner in effect.cases)
            yield from (each for each in first if all(each in other for other in rest))


def _pairs(
    written: Sequence[_Written],
    command: Command,
    query: Command,
    query_effect: Effect,
    encoder_zero: int | None,
) -> Iterator[tuple[str, str | int]]:
    """Yield each field of a query that shows what is written, with the argument or raw value."""
    fields, arguments = reported(query), given(command)
    shown = (
        [(next(iter(fields), ""), query_effect.what)]
        if query_effect.verb == "list"
        else query_effect.values
    )
    if query_effect.verb not in ("reports", "list") or (
        query_effect.verb == "list" and query_effect.option("report") != "count"
    ):
        return
    for name, state in shown:
        for each in written:
            if each.state != state or name not in fields:
                continue
            if each.argument:
                if each.argument in arguments and _alike(fields[name], arguments[each.argument]):
                    yield name, each.argument
            elif (raw := _raw(fields[name], each.value, encoder_zero)) is not None:
                yield name, raw


def _alike(one: Field | None, other: Field | None) -> bool:
    """Return whether two fields have the same number of values, in the same unit."""
    if one is None or other is None:
        return one is other
    shown = _units(one.type)
    if other.selector and not any(unit for unit, _ in shown):
        # The unit depends on another argument, and the query leaves it open.
        return len(shown) == len(other.type.parts)
    types = [type for _, type in other.cases] or [other.type]
    return all(_units(type) == shown for type in types)


def _units(type: Type) -> list[tuple[str, bool]]:
    return [(getattr(part, "unit", ""), getattr(part, "radians", False)) for _, part in type.parts]


def _raw(field: Field | None, value: object, encoder_zero: int | None) -> int | None:
    """Return the raw value that a field reports for a value; None if it is not a single number."""
    if field is None or len(field.type.parts) != 1:
        return None
    if _units(field.type) == [("tick", False)] and value == 0:
        return encoder_zero
    try:
        return raw_values(field.type, field.name, value)[0]
    except ValueError:
        return None


def build_samples(reader: Reader) -> tuple[Samples, ...]:
    """Return the raw values that a conformance run may send; without an entry it may send all."""
    key = language.Command.samples
    node = reader.get(key)
    subject = f"{key.name} of {reader.what}"
    listed = () if node is None else items_of(node, subject, reader.problem)
    return tuple(_samples(entry, subject, reader) for entry in listed)


def _samples(node: Node, subject: str, reader: Reader) -> Samples:
    return tuple(
        (name, Numbers().read(values, f"{name} in {subject}", reader.problem))
        for name, _, values in entries_of(node, f"an entry of {subject}", reader.problem)
    )
