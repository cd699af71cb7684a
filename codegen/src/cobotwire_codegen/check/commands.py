"""Rules for commands: their messages fit the frame, and their ids, aliases and replies agree."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Command, Edition, Field
from cobotwire_codegen.model.commands import NoId

_DIRECTIONS: tuple[Literal["request", "reply"], ...] = ("request", "reply")


def some_command(edition: Edition) -> Iterator[Problem]:
    """Report an edition without commands: its client could do nothing."""
    if not edition.commands:
        yield Problem(edition.place, "no-command", f"the edition {edition.name} has no command")


def ids_fit(edition: Edition) -> Iterator[Problem]:
    """Report ids that do not fit into the bytes of CMD."""
    most = 256**edition.frame.command_number.width - 1
    for command in edition.commands:
        if not 0 <= command.id <= most:
            message = f"the id {command.id} ({command.id:#x}) is not in 0..{most:#x}"
            yield Problem(command.place, "bad-id", message)


def replies_cover_command(edition: Edition) -> Iterator[Problem]:
    """Report replies with fewer data bytes than CMD is wide, if replies carry no CMD."""
    frame = edition.frame
    for command in edition.commands if not frame.replies_have_command else ():
        for variant in command.replies:
            width = frame.sizes["command"]
            if sum(field.type.size for field in variant) < width:
                message = (
                    f"a reply of {command.name} is too short; if replies_have_command is false, "
                    f"each reply needs {width} data bytes or more"
                )
                yield Problem(command.place, "bad-frame", message)
        if command.ack:
            message = f"an acknowledgement of {command.name} cannot be distinguished without CMD"
            yield Problem(command.place, "bad-frame", message)


def payload_fits(edition: Edition) -> Iterator[Problem]:
    """Report messages that are longer than the frame can carry."""
    for command in edition.commands:
        for direction in _DIRECTIONS:
            for variant in command.variants(direction):
                length = sum(f.type.sizes[1] * f.type.element_size for f in variant)
                if length > edition.frame.maximum_data:
                    message = (
                        f"the {direction} of {command.name} has {length} data bytes; the frame "
                        f"can carry {edition.frame.maximum_data}"
                    )
                    yield Problem(command.place, "payload-too-long", message)


def ids_unique(edition: Edition) -> Iterator[Problem]:
    """Report ids that several commands use without `shares_id` or `alias`."""
    seen: dict[int, Command] = {}
    for command in edition.commands:
        if isinstance(command.id, NoId):
            continue
        first = seen.setdefault(command.id, command)
        declared = {first.alias, command.alias, *first.shares_id, *command.shares_id}
        if first is not command and not declared & {first.name, command.name}:
            message = (
                f"{command.name} has the id {command.id:#04x}, like {first.name} at "
                f"{first.place}; if they share it, write shares_id: {first.name}"
            )
            yield Problem(command.place, "duplicate-id", message)


def shared_ids_exist(edition: Edition) -> Iterator[Problem]:
    """Report `shares_id` entries that name an unknown command or one with another id."""
    commands = {command.name: command for command in edition.commands}
    for command in edition.commands:
        for name in command.shares_id:
            other = commands.get(name)
            if other is None:
                message = edition.no_command(name)
                yield Problem(command.place, "unknown-command", message)
            elif other.id != command.id:
                message = f"{name} and {command.name} have different ids; remove shares_id"
                yield Problem(command.place, "bad-shared-id", message)


def aliases_match(edition: Edition) -> Iterator[Problem]:
    """Report aliases whose message differs from that of the command they name."""
    commands = {command.name: command for command in edition.commands}
    for command in edition.commands:
        if not command.alias:
            continue
        other = commands.get(command.alias)
        if other is None:
            message = edition.no_command(command.alias)
            yield Problem(command.place, "unknown-command", message)
        elif _wire(command) != _wire(other):
            message = (
                f"the message of {command.name} differs from that of {other.name}; remove alias"
            )
            yield Problem(command.place, "alias-differs", message)


def _wire(command: Command) -> object:
    variants = (command.requests, command.replies)
    rules = [[[_rule(f) for f in variant] for variant in message] for message in variants]
    return command.id, rules, command.safety


def _rule(field: Field) -> object:
    return field.type.numbers, field.selector


def cases_alike(edition: Edition) -> Iterator[Problem]:
    """Report fields with cases of different sizes."""
    for command in edition.commands:
        for field in command.fields:
            if len({type.size for _, type in field.cases}) > 1:
                message = f"the cases of {field.name} differ in size"
                yield Problem(field.place, "cases-differ-in-size", message)


def echoes_match(edition: Edition) -> Iterator[Problem]:
    """Report echoes that some variant of the request lacks, or has with another type."""
    for command in edition.commands:
        requests = [{field.name: field.type for field in variant} for variant in command.requests]
        for field in command.fields:
            if field.echo and any(variant.get(field.name) != field.type for variant in requests):
                message = f"{field.name} does not echo a field of the request of {command.name}"
                yield Problem(field.place, "bad-echo", message)


def replies_usable(edition: Edition) -> Iterator[Problem]:
    """Report queries without a reply, commands with two replies, and replies that only echo."""
    for command in edition.commands:
        if command.safety == "query" and not command.replies and command.text is None:
            yield Problem(
                command.place, "query-without-reply", f"the query {command.name} has no reply"
            )
        if command.replies and command.text is not None:
            message = f"{command.name} has both a reply and a reply_text"
            yield Problem(command.place, "two-replies", message)
        if command.reply and all(field.echo for field in command.reply):
            message = f"the reply of {command.name} only repeats its request"
            yield Problem(command.place, "empty-reply", message)


def queries_not_acked(edition: Edition) -> Iterator[Problem]:
    """Report queries that are declared as acknowledged."""
    for command in edition.commands:
        if command.ack and command.safety == "query":
            message = (
                f"the query {command.name} cannot have an ack; clients always wait for its reply"
            )
            yield Problem(command.place, "acked-query", message)


RULES = (
    some_command,
    ids_fit,
    replies_cover_command,
    payload_fits,
    ids_unique,
    shared_ids_exist,
    aliases_match,
    cases_alike,
    echoes_match,
    replies_usable,
    queries_not_acked,
)
