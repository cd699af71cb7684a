"""A command with a role has the fields by which the drivers use it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Command, Edition, Enum, Field, Flag, Form, Value

KINDS = {"ANGLES", "COORDS"}


def _row(parts: int) -> Callable[[Command], bool]:
    def has(command: Command) -> bool:
        return all(form and _parts(form[0]) == parts for form in command.requests)

    return has


def _parts(field: Field) -> int:
    return len(field.type.items) if isinstance(field.type, Value) else 0


def _picked(command: Command) -> bool:
    return all(
        len(form) > 1 and not any(_parts(field) for field in form[:2]) for form in command.requests
    )


def _told_by_flag(forms: tuple[Form, ...]) -> bool:
    return bool(forms) and all(len(form) == 1 and isinstance(form[0].type, Flag) for form in forms)


def _asks_a_flag(command: Command) -> bool:
    return command.requests == ((),) and _told_by_flag(command.replies)


def _asks_number(command: Command) -> bool:
    return (
        command.requests == ((),)
        and bool(command.replies)
        and all(len(form) == 1 and not _parts(form[0]) for form in command.replies)
    )


def _asks_row(parts: int) -> Callable[[Command], bool]:
    def asks(command: Command) -> bool:
        rows = all(len(form) == 1 and _parts(form[0]) == parts for form in command.replies)
        return command.requests == ((),) and bool(command.replies) and rows

    return asks


def _reached(command: Command) -> bool:
    if not _told_by_flag(command.replies) or len(command.requests[0]) != 2:
        return False
    kind = command.requests[0][1].type
    return isinstance(kind, Enum) and {member.name for member in kind.members} >= KINDS


def _needs(edition: Edition) -> dict[str, tuple[str, Callable[[Command], bool]]]:
    picks = "its first argument picks the part, its second is the target"
    return {
        "joint targets": ("its first argument is a number for each joint", _row(edition.joints)),
        "coordinate targets": ("its first argument is six coordinates", _row(6)),
        "joint target": (picks, _picked),
        "coordinate target": (picks, _picked),
        "reached": (
            "it takes a target and its kind, ANGLES or COORDS, and answers yes or no",
            _reached,
        ),
        "moving": ("it takes no arguments and answers yes or no", _asks_a_flag),
        "powered": ("it takes no arguments and answers yes or no", _asks_a_flag),
        "version": ("it takes no arguments and answers one number", _asks_number),
        "joints": ("it takes no arguments and answers a number a joint", _asks_row(edition.joints)),
        "coordinates": ("it takes no arguments and answers six coordinates", _asks_row(6)),
        "stop": ("it takes no arguments", lambda command: command.requests == ((),)),
    }


def roles_fit(edition: Edition) -> Iterator[Problem]:
    """What a role needs is there."""
    needs = _needs(edition)
    for command in edition.commands:
        if command.role:
            what, fits = needs[command.role]
            if not fits(command):
                message = f"{command.name} cannot have the role {command.role}: {what}"
                yield Problem(command.place, "bad-role", message)


RULES = (roles_fit,)
