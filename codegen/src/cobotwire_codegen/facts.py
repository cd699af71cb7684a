"""Names the facts of an edition, and counts which sources confirm them.

A fact is EDITION/COMMAND/PART/ASPECT, as a survey names it: ``mycobot280/get_angles/reply/length``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import chain
from typing import NamedTuple, get_args

from cobotwire_codegen.model import (
    Bits,
    Command,
    Edition,
    Field,
    Quantity,
    Scalar,
    Value,
    named_fields,
)
from cobotwire_codegen.model.frame import Direction

DIRECTIONS: tuple[Direction, ...] = get_args(Direction)
ASPECTS = (
    *("id", "length", "scale", "unit", "sign", "order", "range", "limits", "byte-order"),
    *("effect", "agreement", "deadline", "present"),
)
# The kinds of sources that confirm a fact; a later one is nearer to a real arm.
SOURCES = {
    "library": "the maker's library sends and reads the same bytes (`tests/spec`, `make layer`)",
    "page": "the maker's document or page states it",
    "capture": "a public capture of an arm shows it",
    "survey": "an owner's survey, or conformance report, shows it",
}
# Aspects that only an arm can show: no page or library states them as bytes.
ON_AN_ARM = ("effect", "agreement", "deadline")
Confirmed = Mapping[str, frozenset[str]]


def facts_of(edition: Edition) -> dict[str, str]:
    """Return the facts of an edition, each with its command; an alias is not counted again."""
    return {
        f"{edition.name}/{command.name}/{fact}": command.name
        for command in edition.commands
        if not command.alias
        for fact in _facts(command)
    }


def parts_of(command: Command) -> set[str]:
    """Return the parts of a command that a fact can be about."""
    named = chain.from_iterable(
        (f"{direction}.{name}" for name in named_fields(command.variants(direction)))
        for direction in DIRECTIONS
    )
    return {"command", *DIRECTIONS, *named}


def _facts(command: Command) -> Iterator[str]:
    if not command.event:
        yield "command/present"
    if command.awaits_reply:
        yield "command/deadline"
    if command.effect is not None and not command.effect.assumed:
        yield "command/effect"
    if command.agrees_with:
        yield "command/agreement"
    for direction in DIRECTIONS:
        if any(command.variants(direction)):
            yield f"{direction}/length"
        for name, (field, *_) in named_fields(command.variants(direction)).items():
            if not field.echo:
                yield from (f"{direction}.{name}/{aspect}" for aspect in _aspects(field))
    if command.replies:
        yield "reply/id"


def _aspects(field: Field) -> Iterator[str]:
    """Yield the aspects of a field that are facts; the survey's ``facts.py`` has the same rules."""
    types = [type for _, type in field.cases] or [field.type]
    numbers: list[Scalar] = [part for type in types for _, part in type.parts]
    if any(isinstance(type, Value | Bits) for type in types):
        yield "order"
    if any(number.wire.width > 1 for number in numbers):
        yield "byte-order"
    if any(isinstance(number, Quantity) and number.bounds[0] < 0 for number in numbers):
        yield "sign"
    if any(number.scale != 1 or number.unit for number in numbers):
        yield "scale"
    if any(number.unit for number in numbers):
        yield "unit"
    if any(not isinstance(n, Quantity) or n.range is not None or n.choices for n in numbers):
        yield "range"


class Sources(NamedTuple):
    """Sources of facts besides arms: commands of the maker's library, facts of its pages."""

    library: frozenset[str] = frozenset()
    pages: frozenset[str] = frozenset()


NO_SOURCES = Sources()


def confirmed(edition: Edition, sources: Sources = NO_SOURCES) -> Confirmed:
    """Return for each fact of an edition which of SOURCES confirm it."""
    framed = {
        (vector.name.partition("-")[0], fact)
        for vector in edition.vectors
        if vector.derived is None
        for fact in _framed(vector.command, vector.direction)
    }
    observed = {fact.fact for each in edition.observed for fact in each.facts}
    shown = observed - {f.fact for each in edition.observed for f in each.facts if not f.confirmed}
    # If a command is present, its request's length is right: an arm ignores any other length.
    present = [fact for fact in shown if fact.endswith("/command/present")]
    shown |= {fact.replace("command/present", "request/length") for fact in present}
    found = {}
    for name, command in facts_of(edition).items():
        fact, described = name.partition("/")[2], edition.by_name[command]
        stated = fact.rpartition("/")[2] not in ON_AN_ARM
        printed = described.source and not described.changes
        holds = {
            "library": stated and command in sources.library,
            "page": (stated and printed) or fact in sources.pages or ("page", fact) in framed,
            "capture": ("captured", fact) in framed,
            "survey": fact in shown,
        }
        found[name] = frozenset(source for source in SOURCES if holds[source])
    return found


def _framed(command: str, direction: str) -> set[str]:
    """Return the facts that a frame from a source outside of this project shows."""
    shown = {f"{command}/command/present", f"{command}/{direction}/length"}
    return shown | ({f"{command}/reply/id"} if direction == "reply" else set())


_ROW = re.compile(r"(?:(?:[0-9A-F]{2} )+([<>])|[0-9A-F]{2} (\d+|-) (\d+|-)) (\w+)", re.ASCII)


def facts_of_pages(text: str) -> dict[str, set[str]]:
    """Return the facts of each edition that public pages state, from ``public_pages.txt``.

    Rows with a verdict are left out, since there the page contradicts the edition or itself.
    """
    found: dict[str, set[str]] = {}
    edition = ""
    for row in text.splitlines():
        if row.startswith("= "):
            edition = row[2:].partition(" ")[0]
        elif match := _ROW.fullmatch(row):
            arrow, request, reply, command = match.groups()
            stated = zip(DIRECTIONS, (arrow == ">" or request, arrow == "<" or reply))
            for direction in (each for each, size in stated if size and size != "-"):
                found.setdefault(edition, set()).update(_framed(command, direction))
    return found


def counts(found: Confirmed) -> dict[str, int]:
    """Return how many facts are confirmed by each source, by no source, and by no arm."""
    made = {source: sum(source in each for each in found.values()) for source in SOURCES}
    made["none"] = sum(not each for each in found.values())
    return {"facts": len(found), **made, "unconfirmed": len(unconfirmed(found))}


def unconfirmed(found: Confirmed) -> list[str]:
    """Return the facts that no arm has confirmed, in the order of the edition."""
    return [name for name, sources in found.items() if not sources & {"capture", "survey"}]


def bar(part: int, whole: int) -> str:
    """Return a share as a bar of ten blocks with its percentage; 0 % means exactly none."""
    percent = part * 100 // whole if whole else 0
    blocks = (percent + 5) // 10
    shown = f"{percent}" if percent or not part else "<1"
    return f"{'█' * blocks}{'░' * (10 - blocks)} {shown} %"
