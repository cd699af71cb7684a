"""Names become Python: they must be names there, and stay apart."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterator

from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.model import Edition, Enum, Value

_LOWER = re.compile(r"[a-z][a-z0-9_]*\Z")
# A method may keep the maker's capitals: set_HTS_gripper_torque.
_METHOD = re.compile(r"[a-z][A-Za-z0-9_]*\Z")
_UPPER = re.compile(r"[A-Z][A-Z0-9_]*\Z")
_CLASS = re.compile(r"[A-Z][A-Za-z0-9]*\Z")


def words(edition: Edition) -> Iterator[Problem]:
    """Commands, fields, types, members and classes are spelt as Python wants them."""
    for name, place, pattern, example in _named(edition):
        if not pattern.match(name) or keyword.iskeyword(name):
            yield Problem(
                place, "bad-name", f"{name} cannot be a name here; write it like {example}"
            )


def _named(edition: Edition) -> Iterator[tuple[str, Place, re.Pattern[str], str]]:
    yield edition.name, edition.place, _LOWER, "mycobot"
    yield edition.class_name, edition.place, _CLASS, "MyCobot"
    for family in edition.families:
        yield family.name, family.place, _LOWER, "motion"
    for command in edition.commands:
        yield command.name, command.place, _METHOD, "get_angles"
        for field in command.fields:
            yield field.name, field.place, _LOWER, "speed"
        if command.text is not None:
            yield command.text.class_name, command.text.place, _CLASS, "WifiAccount"
        for text in (command.text, command.request_text):
            for name, _ in text.fields if text is not None else ():
                yield name, command.place, _LOWER, "ssid"
    for type in edition.types:
        yield type.name, type.place, _LOWER, "angle"
        if isinstance(type, Enum | Value):
            yield type.class_name, type.place, _CLASS, "Angles"
        if isinstance(type, Enum):
            for member in type.members:
                yield member.name, member.place, _UPPER, "CLOCKWISE"
        if isinstance(type, Value):
            for item, _ in type.items:
                yield item, type.place, _LOWER, "x"


def commands_apart(edition: Edition) -> Iterator[Problem]:
    """No command twice, and no field of a message twice."""
    seen: dict[str, Place] = {}
    for command in edition.commands:
        if command.name in seen:
            message = f"{command.name} is a command already, at {seen[command.name]}"
            yield Problem(command.place, "duplicate-command", message)
        seen.setdefault(command.name, command.place)
        for form in (*command.requests, *command.replies):
            names = [field.name for field in form]
            for index, field in enumerate(form):
                if field.name in names[:index]:
                    yield Problem(field.place, "duplicate-field", f"{field.name} stands twice")


def classes_agree(edition: Edition) -> Iterator[Problem]:
    """Types that share a class have the same parts; an enum shares its class with nobody."""
    seen: dict[str, Enum | Value] = {}
    for type in edition.types:
        if not isinstance(type, Enum | Value):
            continue
        first = seen.setdefault(type.class_name, type)
        if first is not type and _parts(first) != _parts(type):
            message = f"{type.class_name} has other parts at {first.place}"
            yield Problem(type.place, "class-differs", message)


def _parts(type: Enum | Value) -> object:
    if isinstance(type, Enum):
        return type.name
    return [(name, item.unit, item.scale == 1) for name, item in type.items]


RULES = (words, commands_apart, classes_agree)
