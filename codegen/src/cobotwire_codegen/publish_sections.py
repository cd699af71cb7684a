"""The sections of the published document that explain an edition to people."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model import Command, Edition

Record = dict[str, Any]


def sections_for_people(edition: Edition) -> Record:
    """Return what explains the edition: sources, disputes, changes, errata and vectors."""
    return {
        "sources": [_plain_record(source) for source in _sources(edition)],
        "changes": [_plain(change) for change in edition.changes],
        "errata": errata_of(edition),
        "vectors": [_plain(vector) for vector in edition.vectors],
    }


def errata_of(edition: Edition) -> list[Record]:
    """Return the errata of the maker's document."""
    return [_plain(erratum) for erratum in edition.errata]


def places_of(command: Command) -> str:
    """Return where the spec states a command and its changes: ``FILE:LINE FILE:LINE``."""
    spots = (command.place, *(change.place for change in command.changes))
    return " ".join(f"{spot.file}:{spot.line}" for spot in spots)


def _sources(edition: Edition) -> Iterator[Record]:
    """Yield for each named thing its place, its lines in the document, disputes and changes."""
    things: list[tuple[str, Any]] = [("edition", edition), ("frame", edition.frame)]
    things += [("wire", wire) for wire in edition.wires]
    things += [("type", type) for type in edition.types]
    things += [("family", family) for family in edition.families]
    things += [("state", state) for state in edition.states]
    things += [("command", command) for command in edition.commands]
    for kind, thing in things:
        yield given(
            of=kind,
            name=getattr(thing, "name", ""),
            place=thing.place,
            lines=getattr(thing, "source", ()),
            disputed=getattr(thing, "disputed", ()),
            changes=() if kind == "edition" else getattr(thing, "changes", ()),
        )


def _plain_record(record: Record) -> Record:
    return {key: _plain(value) for key, value in record.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, Place):
        return str(value)
    if isinstance(value, Fraction):
        return exact_number(value)
    if isinstance(value, bytes):
        return hexed(value)
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: _plain(getattr(value, field.name)) for field in fields(value)}
    return value


def given(**record: Any) -> Record:
    """Return a record without empty and False values; readers use the defaults."""
    return {key: value for key, value in record.items() if value or type(value) is int}


def exact_number(number: Fraction) -> int | str:
    """Return a whole number, or any other number as text: ``1/100``."""
    return number.numerator if number.denominator == 1 else str(number)


def hexed(data: bytes) -> str:
    """Return bytes as pairs of hex digits."""
    return data.hex(" ").upper()
