"""A command must be sayable in the frame, and readable without doubt."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cobotwire_codegen import lower
from cobotwire_codegen.errors import Problem, nearest
from cobotwire_codegen.model import Command, Edition, Field, Form
from cobotwire_codegen.wire import size

_DIRECTIONS: tuple[Literal["request", "reply"], ...] = ("request", "reply")


def ids_fit(edition: Edition) -> Iterator[Problem]:
    """An id is a byte."""
    for command in edition.commands:
        if not 0 <= command.id <= 0xFF:
            yield Problem(
                command.place, "bad-id", f"the id {command.id} ({command.id:#x}) is no byte"
            )


def payload_fits(edition: Edition) -> Iterator[Problem]:
    """No message is longer than the frame can carry."""
    for command in edition.commands:
        for direction in _DIRECTIONS:
            for form in command.forms(direction):
                length = sum(size(field.type) for field in form)
                if length > edition.frame.maximum_data:
                    message = (
                        f"the {direction} of {command.name} has {length} data bytes; the frame "
                        f"carries {edition.frame.maximum_data}"
                    )
                    yield Problem(command.place, "payload-too-long", message)


def forms_apart(edition: Edition) -> Iterator[Problem]:
    """Messages of one id, direction and length are told apart, or said to be the same."""
    for direction in _DIRECTIONS:
        seen: dict[tuple[int, int], list[tuple[Command, Form]]] = {}
        for command in edition.commands:
            for form in command.forms(direction):
                length = sum(size(field.type) for field in form)
                others = seen.setdefault((command.id, length), [])
                for other, known in others:
                    if not _apart(command, form, other, known, direction):
                        message = (
                            f"the {direction} of {command.name} has the id {command.id:#04x} and "
                            f"{length} data bytes, as {other.name} has at {other.place}"
                        )
                        yield Problem(command.place, "ambiguous-layout", message)
                others.append((command, form))


def _apart(command: Command, form: Form, other: Command, known: Form, direction: str) -> bool:
    """Whether a reader can tell two messages apart, or need not."""
    if command is other:
        return False
    if other.name == command.alias:
        return True
    # The same numbers under the same rule: a reply is read alike, whichever call asked.
    if direction == "reply":
        return [_rule(field) for field in form] == [_rule(field) for field in known]
    constants = [(a.const, b) for a, b in zip(form, known)] + [
        (b.const, a) for a, b in zip(form, known)
    ]
    return any(const is not None and _excludes(field, const) for const, field in constants)


def _rule(field: Field) -> object:
    return lower.numbers(field.type), field.by


def _excludes(field: Field, value: int) -> bool:
    if field.const is not None:
        return field.const != value
    [number] = lower.numbers(field.type)
    inside: bool = number["minimum"] <= value <= number["maximum"]
    return not inside or value not in (lower.choices(field.type) or (value,))


def ids_apart(edition: Edition) -> Iterator[Problem]:
    """An id stands for one call, unless the spec says that calls share it."""
    seen: dict[int, Command] = {}
    for command in edition.commands:
        first = seen.setdefault(command.id, command)
        said = {first.alias, command.alias, *first.shares_id, *command.shares_id}
        if first is not command and not said & {first.name, command.name}:
            message = (
                f"{command.name} has the id {command.id:#04x}, as {first.name} has at "
                f"{first.place}; if they share it, say shares_id: {first.name}"
            )
            yield Problem(command.place, "duplicate-id", message)


def shared_ids_there(edition: Edition) -> Iterator[Problem]:
    """What is said to share an id does."""
    commands = {command.name: command for command in edition.commands}
    for command in edition.commands:
        for name in command.shares_id:
            other = commands.get(name)
            if other is None:
                message = f"there is no command {name}{nearest(name, commands)}"
                yield Problem(command.place, "unknown-command", message)
            elif other.id != command.id:
                message = f"{name} has another id than {command.name}: they share none"
                yield Problem(command.place, "bad-shared-id", message)


def aliases_alike(edition: Edition) -> Iterator[Problem]:
    """An alias is another command's message, byte for byte."""
    commands = {command.name: command for command in edition.commands}
    for command in edition.commands:
        if not command.alias:
            continue
        other = commands.get(command.alias)
        if other is None:
            message = f"there is no command {command.alias}{nearest(command.alias, commands)}"
            yield Problem(command.place, "unknown-command", message)
        elif _wire(command) != _wire(other):
            message = f"{command.name} is not the same message as {other.name}"
            yield Problem(command.place, "alias-differs", message)


def _wire(command: Command) -> object:
    forms = (command.requests, command.replies)
    rules = [[[_rule(f) for f in form] for form in message] for message in forms]
    return command.id, rules, command.safety


def cases_alike(edition: Edition) -> Iterator[Problem]:
    """All cases of a field take the same number of bytes."""
    for command in edition.commands:
        for field in command.fields:
            if len({size(type) for _, type in field.cases}) > 1:
                message = f"the cases of {field.name} differ in length"
                yield Problem(field.place, "uneven-cases", message)


def echoes_match(edition: Edition) -> Iterator[Problem]:
    """An echoed field is in every form of the request, with the same type."""
    for command in edition.commands:
        asked = [{field.name: field.type for field in form} for form in command.requests]
        for field in command.fields:
            if field.echo and any(form.get(field.name) != field.type for form in asked):
                message = f"{field.name} echoes no field of the request of {command.name}"
                yield Problem(field.place, "bad-echo", message)


def replies_decided(edition: Edition) -> Iterator[Problem]:
    """A query has a reply; a reply is a frame or a text; it has more than its echo."""
    for command in edition.commands:
        if command.safety == "query" and not command.replies and command.text is None:
            yield Problem(command.place, "mute-query", f"the query {command.name} has no reply")
        if command.replies and command.text is not None:
            message = f"{command.name} has both a reply and a reply_text"
            yield Problem(command.place, "two-replies", message)
        if command.reply and all(field.echo for field in command.reply):
            message = f"the reply of {command.name} only echoes"
            yield Problem(command.place, "empty-reply", message)


def acks_not_asked(edition: Edition) -> Iterator[Problem]:
    """Only what asks nothing is acknowledged."""
    for command in edition.commands:
        if command.ack and command.safety == "query":
            message = f"the query {command.name} waits for its answer: it has no ack"
            yield Problem(command.place, "acked-query", message)


RULES = (
    ids_fit,
    payload_fits,
    forms_apart,
    ids_apart,
    shared_ids_there,
    aliases_alike,
    cases_alike,
    echoes_match,
    replies_decided,
    acks_not_asked,
)
