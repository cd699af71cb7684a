"""Rules for names: Python accepts them, and they are unique."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterator

from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.language.names import CLASS, LOWER, METHOD, UPPER
from cobotwire_codegen.model import Edition, Type


def words(edition: Edition) -> Iterator[Problem]:
    """Report names of commands, fields, types, members and classes that Python rejects."""
    for name, place, pattern, example in _named(edition):
        # "$" would also match before a line feed at the end.
        if not re.fullmatch(pattern, name) or keyword.iskeyword(name):
            yield Problem(place, "bad-name", f"{name} is not a valid name; write it like {example}")


def _named(edition: Edition) -> Iterator[tuple[str, Place, str, str]]:
    yield edition.name, edition.place, LOWER, "mycobot"
    yield edition.class_name, edition.place, CLASS, "MyCobot"
    for family in edition.families:
        yield family.name, family.place, LOWER, "motion"
    for command in edition.commands:
        yield command.name, command.place, METHOD, "get_angles"
        for field in command.fields:
            yield field.name, field.place, LOWER, "speed"
        if command.text is not None:
            yield command.text.class_name, command.text.place, CLASS, "WifiAccount"
        for text in (command.text, command.request_text):
            for name, _ in text.fields if text is not None else ():
                yield name, command.place, LOWER, "ssid"
    for type in edition.types:
        yield type.name, type.place, LOWER, "angle"
        if type.class_name:
            yield type.class_name, type.place, CLASS, "Angles"
        for member in type.members:
            yield member.name, member.place, UPPER, "CLOCKWISE"
        for part, _ in type.parts:
            if part:
                yield part, type.place, LOWER, "x"


def commands_apart(edition: Edition) -> Iterator[Problem]:
    """Report commands with the same name, and fields with the same name in one message."""
    seen: dict[str, Place] = {}
    for command in edition.commands:
        if command.name in seen:
            message = f"there is already a command {command.name} at {seen[command.name]}"
            yield Problem(command.place, "duplicate-command", message)
        seen.setdefault(command.name, command.place)
        for variant in (*command.requests, *command.replies):
            names = [field.name for field in variant]
            for index, field in enumerate(variant):
                if field.name in names[:index]:
                    yield Problem(field.place, "duplicate-field", f"{field.name} is given twice")


def classes_agree(edition: Edition) -> Iterator[Problem]:
    """Report types that share a class but not its parts; an enum never shares its class."""
    seen: dict[str, Type] = {}
    for type in edition.types:
        if not type.class_name:
            continue
        first = seen.setdefault(type.class_name, type)
        if first is not type and _parts(first) != _parts(type):
            message = f"{type.class_name} has different parts at {first.place}"
            yield Problem(type.place, "class-differs", message)


def _parts(type: Type) -> object:
    if type.members:
        return type.name
    return [(name, part.unit, part.scale == 1) for name, part in type.parts]


RULES = (words, commands_apart, classes_agree)
