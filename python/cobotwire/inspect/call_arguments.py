"""Parse the arguments of a command as people write them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cobotwire.protocol.arguments import choose
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Field, Variant

_FLAGS = {"true": True, "yes": True, "on": True, "1": True}
_FLAGS |= {"false": False, "no": False, "off": False, "0": False}


def parse(command: Command, words: Sequence[str]) -> dict[str, Any]:
    """Return the arguments by name; words come in the order of the method or as ``name=value``.

    The given names choose the variant of the request. Arguments with a default may be left out. The
    text that follows a request is an argument like the fields.

    Raises:
        UsageError: an argument is missing, unknown, given twice, or not a value of its field.
    """
    text = command.request_text.fields if command.request_text else ()
    given = _by_name(command, command.argument_names, words)
    for name in text:
        if name not in given:
            message = f"{command.name}() is missing its argument {name}"
            raise UsageError(name, message=f"{message}; {_takes(command.argument_names)}")
    fields = {field.name: field for field in _variant(command, given).fields}
    return {
        name: word if name in text else parse_value(fields[name], word)
        for name, word in given.items()
    }


def request_values(command: Command, given: Mapping[str, Any]) -> tuple[Any, ...]:
    """Return the values of the request's frame: the arguments, defaults and constants."""
    return tuple(
        ...
        if field.counts
        else given[field.name]
        if field.name in given
        else field.physical(field.default or (field.const or 0,))
        for field in _variant(command, given).fields
    )


def variant_of(command: Command, given: Mapping[str, Any]) -> int | None:
    """Return the index of the variant of a request that the given arguments choose.

    None: they have a size of their own, by which the codec chooses.
    """
    variant = _variant(command, given)
    if any(field.sizes for field in variant.fields):
        return None
    return command.request.index(variant)


def _variant(command: Command, given: Mapping[str, Any]) -> Variant:
    text = command.request_text.fields if command.request_text else ()
    fields = [name for name in command.argument_names if name in given and name not in text]
    rows = tuple(variant.row for variant in command.request)
    try:
        chosen = choose(command.name, rows, fields)
    except TypeError as error:
        raise UsageError("arguments", message=str(error)) from None
    return command.request[chosen.first]


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
    """Parse a word as the value of a field: ``1,2`` is a row, ``1,2;3,4`` a list of rows.

    Raises:
        UsageError: the word is not a number, a flag or a member of the field's enum, or not the
            hex digits of bytes.
    """
    if field.kind == "text":
        return [part for part in word.split(",") if part] if field.each else word
    if field.kind == "bytes":
        return _bytes(field, word)
    if field.each:
        groups = [part.strip(" []()") for part in word.split(";")]
        return [[_number(field, part.strip()) for part in g.split(",")] for g in groups if g]
    if field.many and not word.strip("[]() "):
        return []
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


def _bytes(field: Field, word: str) -> bytes:
    try:
        return bytes.fromhex(word)
    except ValueError:
        raise UsageError(field.name, word, "pairs of hex digits") from None


def _number(field: Field, word: str) -> int | float:
    for number in (lambda text: int(text, 0), float):
        try:
            return number(word)
        except ValueError:
            continue
    raise UsageError(field.name, word, "a number")
