"""The sections of the published document that explain an edition to people."""

from __future__ import annotations

import os.path
from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

from cobotwire_codegen.errors import Place
from cobotwire_codegen.model import Command, Edition
from cobotwire_codegen.model.types import exact_number as exact_number

Record = dict[str, Any]
# Fields of records that hold pairs of a name and a value.
_BY_NAME = ("values", "accepted", "refused")


def sections_for_people(edition: Edition) -> Record:
    """Return the sections that explain an edition: sources, changes, errata and vectors."""
    return {
        "sources": [_plain(source, edition) for source in _sources(edition)],
        "changes": _plain(edition.changes, edition),
        "errata": errata_of(edition),
        "vectors": _plain(edition.vectors, edition),
    }


def errata_of(edition: Edition) -> list[Record]:
    """Return the errata of the maker's document."""
    return [_plain(erratum, edition) for erratum in edition.errata]


def places_of(command: Command, edition: Edition) -> str:
    """Return where the spec states a command and its changes: ``FILE:LINE FILE:LINE``."""
    spots = (command.place, *(change.place for change in command.changes))
    return " ".join(f"{published_file(spot.file, edition)}:{spot.line}" for spot in spots)


def published_file(file: str, edition: Edition) -> str:
    """Return the name of a file of the spec, which is the same on every machine.

    It is relative to the folder of the edition's file. If a folder ``spec`` with ``editions``
    contains the file, as in this project, the name starts with ``spec``.
    """
    path = edition.root / file
    home = _home(edition.root / edition.place.file)
    shipped = _home(path)
    if not path.is_relative_to(home) and shipped != path.parent:
        home = shipped
    try:
        return Path(os.path.relpath(path, home)).as_posix()
    except ValueError:  # on another drive of Windows
        return path.name


@cache
def _home(path: Path) -> Path:
    """Return the folder to which the names of an edition's files are relative."""
    specs = (above for above in path.parents if above.name == "spec")
    return next((spec.parent for spec in specs if (spec / "editions").is_dir()), path.parent)


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
            firmware=thing.firmware if kind == "command" else None,
            changes=() if kind == "edition" else getattr(thing, "changes", ()),
        )


def _plain(value: Any, edition: Edition, name: str = "") -> Any:
    """Return the value of a record's field as JSON."""
    if isinstance(value, Place):
        return f"{published_file(value.file, edition)}:{value.line}:{value.column}"
    if isinstance(value, Fraction):
        return exact_number(value)
    if isinstance(value, bytes):
        return hexed(value)
    if name == "lines":
        return published_lines(value)
    if name == "rejected" and value:
        return {"reason": value[0], "offset": value[1]}
    if isinstance(value, tuple):
        if name in _BY_NAME:
            return {name: _plain(part, edition) for name, part in value}
        return [_plain(item, edition) for item in value]
    if is_dataclass(value) and not isinstance(value, type):
        value = {field.name: getattr(value, field.name) for field in fields(value)}
    if isinstance(value, dict):
        return {name: _plain(part, edition, name) for name, part in value.items()}
    return value


def published_lines(lines: Iterable[tuple[int, int]]) -> list[Record]:
    """Return ranges of lines of the maker's document."""
    return [{"first": first, "last": last} for first, last in lines]


def given(**record: Any) -> Record:
    """Return a record without empty and False values; readers use the defaults."""
    return {key: value for key, value in record.items() if value or type(value) is int}


def hexed(data: bytes) -> str:
    """Return bytes as pairs of hex digits."""
    return data.hex(" ").upper()
