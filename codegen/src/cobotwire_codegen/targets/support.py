"""Refuses editions with types that an output target cannot express yet."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen import lower
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.model import Edition, Quantity, Type, Value


def require_plain(edition: Edition, target: str) -> None:
    """Raise an error unless every message has only integers, enums, flags and values of them.

    Raises:
        SpecError: a field has another type; the text names the command, the field and the type.
    """
    problems = list(_unsupported(edition, target))
    if problems:
        raise SpecError(problems)


def _unsupported(edition: Edition, target: str) -> Iterator[Problem]:
    for command in edition.commands:
        for field in command.fields:
            for _, type in lower.cases(field):
                kind = _other_kind(type)
                if kind:
                    message = (
                        f"the {target} target cannot express {field.name} of {command.name}: "
                        f"{type.name} is {kind}"
                    )
                    yield Problem(field.place, "unsupported-type", message)


def _other_kind(type: Type) -> str:
    parts = [item for _, item in type.items] if isinstance(type, Value) else [type]
    if any(isinstance(part, Quantity) and part.wire.is_float for part in parts):
        return "a float"
    return ""
