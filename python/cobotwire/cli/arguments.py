"""Words of the command line to the values of a command's fields."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cobotwire.errors import UsageError
from cobotwire.table import Command, Field

_YES = {"true": True, "yes": True, "on": True, "1": True}
_NO = {"false": False, "no": False, "off": False, "0": False}


def parse(command: Command, words: Sequence[str], texts: Sequence[str] = ()) -> list[Any]:
    """Values in the order of the fields; words stand in that order or as ``name=value``.

    ``texts`` names what follows the frame as plain text: such a word is taken as it is.

    Raises:
        UsageError: too many words, a missing one, an unknown name, or a word that is no value.
    """
    fields = command.request[0].fields
    names = [*(field.name for field in fields), *texts]
    given: dict[str, str] = {}
    for word in words:
        name, equals, value = word.partition("=")
        # A password may have the sign in it.
        if not equals or (texts and name not in names):
            free = [name for name in names if name not in given]
            if not free:
                raise UsageError("argument", word, f"{len(names)} value(s): {_wanted(names)}")
            name, value = free[0], word
        if name not in names or name in given:
            raise UsageError("argument", word, f"each once: {_wanted(names)}")
        given[name] = value
    for name in names:
        if name not in given:
            raise UsageError(name, None, f"a value; {command.name} takes {_wanted(names)}")
    values = [value_of(field, given[field.name]) for field in fields]
    return [*values, *(given[name] for name in texts)]


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
