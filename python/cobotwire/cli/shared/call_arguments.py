"""Parse the arguments of a command as they are written on the command line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Field, Variant

_FLAGS = {"true": True, "yes": True, "on": True, "1": True}
_FLAGS |= {"false": False, "no": False, "off": False, "0": False}


def parse(command: Command, words: Sequence[str]) -> dict[str, Any]:
    """Return the arguments by name; words come in the order of the fields or as ``name=value``.

    Fields that a shorter variant of the request leaves out are optional; constant fields are not
    arguments. The text that follows a request is an argument like the fields.

    Raises:
        UsageError: an argument is missing, unknown, given twice, or not a value of its field.
    """
    text = command.request_text.fields if command.request_text else ()
    names = [*(field.name for field in _arguments(command.request[0])), *text]
    given = _by_name(command, names, words)
    for variant in command.request:
        fields = _arguments(variant)
        if {*(field.name for field in fields), *text} == set(given):
            values = {field.name: parse_value(field, given[field.name]) for field in fields}
            return values | {name: given[name] for name in text}
    missing = next(name for name in names if name not in given)
    message = f"{command.name}() is missing its argument {missing}; {_takes(names)}"
    raise UsageError(missing, message=message)


def request_values(command: Command, given: Mapping[str, Any]) -> tuple[Any, ...]:
    """Return the values of the request's frame, constant fields included."""
    fits = (v for v in command.request if all(field.name in given for field in _arguments(v)))
    return tuple(
        given.get(field.name, field.choices and field.choices[0]) for field in next(fits).fields
    )


def _arguments(variant: Variant) -> list[Field]:
    """Return the fields that are arguments: all but those with one legal value and no label."""
    return [field for field in variant.fields if len(field.choices) != 1 or field.labels]


def _by_name(command: Command, names: Sequence[str], words: Sequence[str]) -> dict[str, str]:
    given: dict[str, str] = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals:
            name, value = next((free for free in names if free not in given), ""), word
        if name not in names:
            message = f"{command.name}() has no argument for {word!r}; {_takes(names)}"
            raise UsageError("argument", word, message=message)
        if name in given:
            raise UsageError(name, word, message=f"{command.name}() got its argument {name} twice")
        given[name] = value
    return given


def _takes(names: Sequence[str]) -> str:
    return f"it takes {', '.join(names) or 'no arguments'}"


def parse_value(field: Field, word: str) -> Any:
    """Parse a word as the value of a field.

    Raises:
        UsageError: the word is not a number, a flag or a member of the field's enum.
    """
    if field.many:
        return [_number(field, part.strip()) for part in word.strip("[]()").split(",")]
    if field.kind == "flag":
        if word.lower() not in _FLAGS:
            raise UsageError(field.name, word, "on or off")
        return _FLAGS[word.lower()]
    if word.upper() in field.labels:
        return field.choices[field.labels.index(word.upper())]
    if field.labels and not word.isdigit():
        members = (f"{label} ({choice})" for label, choice in zip(field.labels, field.choices))
        raise UsageError(field.name, word, ", ".join(members))
    return _number(field, word)


def _number(field: Field, word: str) -> int | float:
    for number in (lambda text: int(text, 0), float):
        try:
            return number(word)
        except ValueError:
            continue
    raise UsageError(field.name, word, "a number")
