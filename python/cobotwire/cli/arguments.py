"""Words of the command line to the values of a command's fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cobotwire.errors import UsageError
from cobotwire.table import Command, Field, Layout

_YES = {"true": True, "yes": True, "on": True, "1": True}
_NO = {"false": False, "no": False, "off": False, "0": False}


def parse(command: Command, words: Sequence[str]) -> dict[str, Any]:
    """Values by name, in the fields' order; words stand in that order or as ``name=value``.

    What a shorter form of the request leaves out may be left out; what is always the same is not
    given. The text behind a request is given as it is.

    Raises:
        UsageError: too many words, a missing one, an unknown name, or a word that is no value.
    """
    text = command.request_text.fields if command.request_text else ()
    names = [*(field.name for field in _asked(command.request[0])), *text]
    given = _named(names, words)
    for form in command.request:
        asked = _asked(form)
        if {*(field.name for field in asked), *text} == set(given):
            values = {field.name: value_of(field, given[field.name]) for field in asked}
            return values | {name: given[name] for name in text}
    missing = next(name for name in names if name not in given)
    raise UsageError(missing, None, f"a value; {command.name} takes {_wanted(names)}")


def framed(command: Command, given: Mapping[str, Any]) -> tuple[Any, ...]:
    """The values of the request's frame, what is always the same included."""
    form = next(f for f in command.request if all(x.name in given for x in _asked(f)))
    return tuple(given.get(field.name, field.choices and field.choices[0]) for field in form.fields)


def _asked(form: Layout) -> list[Field]:
    """The fields that a caller gives; a list of one number leaves nothing to say."""
    return [field for field in form.fields if len(field.choices) != 1 or field.labels]


def _named(names: Sequence[str], words: Sequence[str]) -> dict[str, str]:
    """The words by the names of the fields that they are for."""
    given: dict[str, str] = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals:
            free = [name for name in names if name not in given]
            if not free:
                raise UsageError("argument", word, f"{len(names)} value(s): {_wanted(names)}")
            name, value = free[0], word
        if name not in names or name in given:
            raise UsageError("argument", word, f"each once: {_wanted(names)}")
        given[name] = value
    return given


def _wanted(names: Sequence[str]) -> str:
    return ", ".join(names) or "no values"


def value_of(field: Field, word: str) -> Any:
    """One word as a value; lists are separated by commas, enum members go by name or number."""
    if field.many:
        return [_number(field, part.strip()) for part in word.strip("[]()").split(",")]
    if field.kind == "flag":
        choices = {**_YES, **_NO}
        if word.lower() not in choices:
            raise UsageError(field.name, word, "on or off")
        return choices[word.lower()]
    if word.upper() in field.labels:
        return field.choices[field.labels.index(word.upper())]
    if field.labels and not word.isdigit():
        raise UsageError(field.name, word, f"one of {', '.join(field.labels)}")
    return _number(field, word)


def _number(field: Field, word: str) -> int | float:
    try:
        return int(word, 0)
    except ValueError:
        pass
    try:
        return float(word)
    except ValueError:
        raise UsageError(field.name, word, "a number") from None
