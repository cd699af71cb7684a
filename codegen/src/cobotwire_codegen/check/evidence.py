"""Rules for vectors, errata and observed facts: they agree with the commands."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Literal

from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.facts import ASPECTS, parts_of
from cobotwire_codegen.model import Command, Edition, Variant, Vector
from cobotwire_codegen.wire import build_frame

Direction = Literal["request", "reply"]
Values = dict[str, object]


def vectors_hold(edition: Edition) -> Iterator[Problem]:
    """Report vectors with values that encode to another frame."""
    commands = {command.name: command for command in edition.commands}
    for vector in edition.vectors:
        command = commands.get(vector.command)
        if command is None:
            message = edition.no_command(vector.command)
            yield Problem(vector.place, "unknown-command", message)
        elif vector.frame is not None:
            values, address = dict(vector.values), edition.frame.address_in(vector.frame)
            try:
                built = build_frame(edition.frame, command, vector.direction, values, address)
            except ValueError as error:
                yield Problem(vector.place, "unencodable-vector", f"{vector.name}: {error}")
                continue
            if built != vector.frame:
                message = f"{vector.name}: the values encode to {built.hex(' ').upper()}"
                yield Problem(vector.place, "vector-differs", message)


def limits_hold(edition: Edition) -> Iterator[Problem]:
    """Report values that a vector states as accepted or refused although they are not."""
    commands = {command.name: command for command in edition.commands}
    for vector in edition.vectors:
        command = commands.get(vector.command)
        given = dict(vector.values)
        for limits, legal in ((vector.accepted, True), (vector.refused, False)):
            for name, values in limits:
                if command is None or name not in given or vector.frame is None:
                    message = f"{vector.name} has no field {name}{nearest(name, given)}"
                    yield Problem(vector.place, "unencodable-vector", message)
                    continue
                for value in values:
                    if _encodes(edition, command, vector, given | {name: value}) != legal:
                        verb = "refuses" if legal else "accepts"
                        message = f"{vector.name}: {command.name} {verb} {_shown(value)} as {name}"
                        yield Problem(vector.place, "limit-differs", message)


def _encodes(edition: Edition, command: Command, vector: Vector, values: Values) -> bool:
    try:
        build_frame(edition.frame, command, vector.direction, values)
    except ValueError:
        return False
    return True


def _shown(value: object) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_shown, value))}]"
    return f"{float(value):g}" if isinstance(value, Fraction) else str(value)


def text_vectors_hold(edition: Edition) -> Iterator[Problem]:
    """Report text vectors with values that encode to another text."""
    texts = {command.name: command.text for command in edition.commands}
    for vector in edition.vectors:
        text = texts.get(vector.command)
        if vector.text is None:
            continue
        values = dict(vector.values)
        if text is None or list(values) != [name for name, _ in text.fields]:
            message = f"{vector.name}: {vector.command} has no text reply with these fields"
            yield Problem(vector.place, "unencodable-vector", message)
            continue
        built = "".join(
            f"{prefix}{values[name]}" for prefix, (name, _) in zip(text.prefixes, text.fields)
        )
        if built != vector.text:
            yield Problem(
                vector.place, "vector-differs", f"{vector.name}: the values encode to `{built}`"
            )


def every_variant_shown(edition: Edition) -> Iterator[Problem]:
    """Report variants that no vector shows."""
    for command, direction, variant in unshown(edition):
        fields = ", ".join(field.name for field in variant) or "no fields"
        message = f"no vector shows the {direction} of {command.name} with {fields}"
        yield Problem(command.place, "no-vector", message)


def unshown(edition: Edition) -> Iterator[tuple[Command, Direction, Variant]]:
    """Yield the variants that no vector shows, each with its command and direction."""
    directions: tuple[Direction, ...] = ("request", "reply")
    shown = {
        (vector.command, vector.direction, tuple(name for name, _ in vector.values))
        for vector in edition.vectors
        if vector.frame is not None
    }
    for command in edition.commands:
        for direction in directions:
            for variant in command.variants(direction):
                names = tuple(field.name for field in variant)
                if (command.name, direction, names) not in shown:
                    yield command, direction, variant


def printed_explained(edition: Edition) -> Iterator[Problem]:
    """Report printed examples that contradict their verdict or frame without an erratum."""
    if edition.base:
        return  # the document's examples and its errata belong to the base
    explained = {erratum.example for erratum in edition.errata}
    for vector in edition.vectors:
        if vector.example is None:
            continue
        if vector.verdict != "consistent" and vector.example not in explained:
            message = f"{vector.name} has the verdict {vector.verdict}, but no erratum explains why"
            yield Problem(vector.place, "unexplained-example", message)
        if vector.verdict == "consistent" and not _same(vector):
            message = (
                f"{vector.name} has the verdict consistent, but its frame is not the printed one"
            )
            yield Problem(vector.place, "unexplained-example", message)


def _same(vector: Vector) -> bool:
    return vector.printed == vector.frame


def vectors_apart(edition: Edition) -> Iterator[Problem]:
    """Report vectors with the same name."""
    seen: dict[str, Vector] = {}
    for vector in edition.vectors:
        first = seen.setdefault(vector.name, vector)
        if first is not vector:
            message = f"there is already a vector {vector.name} at {first.place}"
            yield Problem(vector.place, "duplicate-vector", message)


def errata_name_commands(edition: Edition) -> Iterator[Problem]:
    """Report errata that name unknown commands."""
    known = {command.name for command in edition.commands}
    for erratum in edition.errata:
        for name in erratum.commands:
            if name not in known:
                message = edition.no_command(name)
                yield Problem(erratum.place, "unknown-command", message)


def facts_named(edition: Edition) -> Iterator[Problem]:
    """Report evidence and disputes about unknown commands, parts or aspects."""
    named = [(fact.place, fact.fact) for each in edition.observed for fact in each.facts]
    for command in edition.commands:
        named += [(d.place, f"{command.name}/{d.about}") for d in command.disputed if d.about]
    for place, fact in named:
        name, _, rest = fact.partition("/")
        part, _, aspect = rest.partition("/")
        found = edition.by_name.get(name)
        if found is None:
            yield Problem(place, "unknown-command", edition.no_command(name))
        elif part not in parts_of(found) or aspect not in ASPECTS:
            known = [*parts_of(found), *ASPECTS]
            hint = nearest(part if part not in known else aspect, known)
            yield Problem(place, "unknown-fact", f"{name} has no fact {rest}{hint}")


RULES = (
    vectors_apart,
    vectors_hold,
    limits_hold,
    text_vectors_hold,
    every_variant_shown,
    printed_explained,
    errata_name_commands,
    facts_named,
)
