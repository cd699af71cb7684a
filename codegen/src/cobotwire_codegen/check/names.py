"""Rules for names: they are unique, and types of one class agree.

``language/names.py`` states what a name may be.
"""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire_codegen.errors import Place, Problem
from cobotwire_codegen.model import Edition, Type


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
                if field.name and field.name in names[:index]:
                    yield Problem(field.place, "duplicate-field", f"{field.name} is given twice")


def classes_agree(edition: Edition) -> Iterator[Problem]:
    """Report types with the same class but different parts, and enums with another type's class."""
    seen: dict[str, Type] = {}
    for type in edition.types:
        if not type.class_name:
            continue
        first = seen.setdefault(type.class_name, type)
        if first is not type and _parts(first) != _parts(type):
            message = f"the class {type.class_name} has other parts at {first.place}"
            if first.members or type.members:
                message = (
                    f"the class {type.class_name} is used at {first.place}; an enum needs its own"
                )
            yield Problem(type.place, "class-differs", message)


def _parts(type: Type) -> object:
    if type.members:
        return type.name
    return [(name, part.unit, part.scale == 1) for name, part in type.parts]


RULES = (commands_apart, classes_agree)
