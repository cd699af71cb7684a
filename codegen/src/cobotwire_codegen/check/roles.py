"""Rules for roles: a command has the fields that its role needs."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Command, Edition, Field, Variant

KINDS = {"ANGLES", "COORDS"}


def _row(parts: int) -> Callable[[Command], bool]:
    def has(command: Command) -> bool:
        return all(variant and _parts(variant[0]) == parts for variant in command.requests)

    return has


def _parts(field: Field) -> int:
    return len(field.type.parts) if field.type.kind == "value" else 0


def _picked(command: Command) -> bool:
    return all(
        len(variant) > 1 and not any(_parts(field) for field in variant[:2])
        for variant in command.requests
    )


def _replies_with_flag(variants: tuple[Variant, ...]) -> bool:
    return bool(variants) and all(
        len(variant) == 1 and variant[0].type.kind == "flag" for variant in variants
    )


def _reads_flag(command: Command) -> bool:
    return command.requests == ((),) and _replies_with_flag(command.replies)


def _reads_number(command: Command) -> bool:
    return (
        command.requests == ((),)
        and bool(command.replies)
        and all(len(variant) == 1 and not _parts(variant[0]) for variant in command.replies)
    )


def _error(command: Command) -> bool:
    last = [variant[-1] for variant in command.replies if variant]
    ends = bool(last) and all(not _parts(field) for field in last)
    return command.requests == ((),) and ends


def _reads_row(parts: int) -> Callable[[Command], bool]:
    def reads(command: Command) -> bool:
        rows = all(len(variant) == 1 and _parts(variant[0]) == parts for variant in command.replies)
        return command.requests == ((),) and bool(command.replies) and rows

    return reads


def _reached(command: Command) -> bool:
    if not _replies_with_flag(command.replies) or len(command.requests[0]) != 2:
        return False
    kind = command.requests[0][1].type
    return {member.name for member in kind.members} >= KINDS


def _needs(edition: Edition) -> dict[str, tuple[str, Callable[[Command], bool]]]:
    picks = "its first argument must select the part and its second be the target"
    return {
        "joint targets": (
            "its first argument must have a number for each joint",
            _row(edition.joints),
        ),
        "coordinate targets": ("its first argument must be six coordinates", _row(6)),
        "joint target": (picks, _picked),
        "coordinate target": (picks, _picked),
        "reached": (
            "it must take a target and its kind, ANGLES or COORDS, and reply with a flag",
            _reached,
        ),
        "moving": ("it must take no arguments and reply with a flag", _reads_flag),
        "powered": ("it must take no arguments and reply with a flag", _reads_flag),
        "paused": ("it must take no arguments and reply with a flag", _reads_flag),
        "error": (
            "it must take no arguments, and the last of its replies must be a number",
            _error,
        ),
        "version": ("it must take no arguments and reply with one number", _reads_number),
        "joints": (
            "it must take no arguments and reply with a number for each joint",
            _reads_row(edition.joints),
        ),
        "coordinates": ("it must take no arguments and reply with six coordinates", _reads_row(6)),
        "stop": ("it must take no arguments", lambda command: command.requests == ((),)),
    }


def roles_fit(edition: Edition) -> Iterator[Problem]:
    """Report commands that lack what their role needs."""
    needs = _needs(edition)
    for command in edition.commands:
        if command.role:
            what, fits = needs[command.role]
            if not fits(command):
                message = f"{command.name} cannot have the role {command.role}: {what}"
                yield Problem(command.place, "bad-role", message)


RULES = (roles_fit,)
