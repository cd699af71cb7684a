"""Rules for roles: a command has the fields that its role needs."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Command, Edition, Enum, Field, Quantity, Variant

KINDS = {"ANGLES", "COORDS"}
GRIPS = {"OPEN", "CLOSE"}


def _parts(field: Field) -> int:
    return len(field.type.parts) if field.type.kind == "value" else 0


def _row(parts: int) -> Callable[[Command], bool]:
    """Return the rule that each request has one field of ``parts`` numbers, and further fields."""

    def has(command: Command) -> bool:
        return bool(parts) and all(
            [_parts(field) for field in variant if _parts(field)] == [parts] and len(variant) > 1
            for variant in command.requests
        )

    return has


def _is_picker(field: Field) -> bool:
    """Return whether a field can select a part: it is a number without unit and scale."""
    type = field.type
    return not isinstance(type, Quantity) or (type.scale == 1 and not type.unit)


def _is_target(field: Field) -> bool:
    """Return whether a field can be a target: it has a selector, or a unit that is not a speed."""
    if field.selector:
        return True
    type = field.type
    return isinstance(type, Quantity) and type.unit != "percent" and not _is_picker(field)


def _picked(command: Command) -> bool:
    """Return whether each request has a target, and an argument that selects the part."""
    return all(
        not any(_parts(field) for field in variant)
        and any(_is_target(field) for field in variant)
        and any(_is_picker(field) and not _is_target(field) for field in variant)
        for variant in command.requests
    )


def _replies_with_flag(variants: tuple[Variant, ...]) -> bool:
    return bool(variants) and all(
        len(variant) == 1 and variant[0].type.kind == "flag" for variant in variants
    )


def _reads_flag(command: Command) -> bool:
    return command.requests == ((),) and _replies_with_flag(command.replies)


def _reads_power(command: Command) -> bool:
    if _reads_flag(command):
        return True
    # Table.find_setter looks for the value 1; every other member must be false in a condition.
    return command.requests == ((),) and all(
        len(variant) == 1
        and isinstance(variant[0].type, Enum)
        and [m.value for m in variant[0].type.members if m.value and not m.falsy] == [1]
        for variant in command.replies
    )


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


def _grips(command: Command) -> bool:
    """Return whether each request has a state that may be OPEN or CLOSE, and a speed."""
    return all(
        [{member.name for member in field.type.members} >= GRIPS for field in variant[:2]]
        == [True, False]
        for variant in command.requests
    )


def _reads_row(parts: int) -> Callable[[Command], bool]:
    def reads(command: Command) -> bool:
        rows = parts and all(
            len(variant) == 1 and _parts(variant[0]) == parts for variant in command.replies
        )
        return command.requests == ((),) and bool(command.replies) and bool(rows)

    return reads


def _reached(joints: int) -> Callable[[Command], bool]:
    """Return the rule that a query takes a target, perhaps its kind, and replies with a flag."""

    def reached(command: Command) -> bool:
        variant = command.requests[0]
        rows = [field for field in variant if _parts(field)]
        others = [field for field in variant if field not in rows]
        if not _replies_with_flag(command.replies) or len(rows) != 1 or len(others) > 1:
            return False
        if not others:
            return _parts(rows[0]) == joints
        return {member.name for member in others[0].type.members} >= KINDS

    return reached


def _coordinates(edition: Edition) -> int:
    """Return the number of coordinates in the first command with a role about coordinates."""
    for command in edition.commands:
        messages = {"coordinate targets": command.requests, "coordinates": command.replies}
        for variant in messages.get(command.role, ()):
            for field in variant:
                if _parts(field):
                    return _parts(field)
    return 0


def _needs(edition: Edition) -> dict[str, tuple[str, Callable[[Command], bool]]]:
    picks = (
        "one argument must select the joint or axis; another one, with a unit or a scale, must be "
        "the target"
    )
    coordinates = _coordinates(edition)
    alike = "the roles coordinates and coordinate targets need the same number of them"
    return {
        "joint targets": (
            "it must take a value type with a number for each joint, and a speed",
            _row(edition.joints),
        ),
        "coordinate targets": (
            f"it must take a value type of coordinates, and a speed; {alike}",
            _row(coordinates),
        ),
        "joint target": (picks, _picked),
        "coordinate target": (picks, _picked),
        "reached": (
            "it must take a target and its kind, ANGLES or COORDS, or only a number for each "
            "joint, and reply with a flag",
            _reached(edition.joints),
        ),
        "moving": ("it must take no arguments and reply with a flag", _reads_flag),
        "powered": (
            "it must take no arguments and reply with a flag, or an enum in which only 1 is true",
            _reads_power,
        ),
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
        "coordinates": (
            f"it must take no arguments and reply with a value type of coordinates; {alike}",
            _reads_row(coordinates),
        ),
        "motion ended": (
            "it must be an event, and the last field of its reply must be a status",
            lambda c: c.event and any(c.replies[:1]) and not _parts(c.replies[0][-1]),
        ),
        "gripper": ("it must take first a state, OPEN or CLOSE, then a speed", _grips),
        "stop": ("it must need no arguments", lambda command: () in command.requests),
        "halt": ("its safety class must be motion", lambda command: command.safety == "motion"),
        "light": ("its safety class must be setting", lambda command: command.safety == "setting"),
    }


def roles_fit(edition: Edition) -> Iterator[Problem]:
    """Report commands that lack what their role needs."""
    needs = _needs(edition)
    for command in edition.commands:
        if command.role:
            what, fits = needs[command.role]
            if command.event != (command.role == "motion ended") or not fits(command):
                message = f"{command.name} cannot have the role {command.role}: {what}"
                yield Problem(command.place, "bad-role", message)


def events_fit(edition: Edition) -> Iterator[Problem]:
    """Report events with a request, an acknowledgement, or another safety class than query."""
    for command in edition.commands:
        sent = command.requests or command.ack or command.text or command.request_text
        if command.event and (sent or not command.replies or command.safety != "query"):
            message = (
                f"the event {command.name} must have a reply, no request, and the safety query"
            )
            yield Problem(command.place, "bad-event", message)


RULES = (roles_fit, events_fit)
