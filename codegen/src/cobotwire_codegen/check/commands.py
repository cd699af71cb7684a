"""A command must be sayable in the frame, and readable without doubt."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cobotwire_codegen.errors import Problem
from cobotwire_codegen.model import Command, Edition
from cobotwire_codegen.wire import size

_DIRECTIONS: tuple[Literal["request", "reply"], ...] = ("request", "reply")


def ids_fit(edition: Edition) -> Iterator[Problem]:
    """An id is a byte."""
    for command in edition.commands:
        if not 0 <= command.id <= 0xFF:
            yield Problem(command.place, "bad-id", f"the id {command.id:#x} is no byte")


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
    """Messages of one id and direction are told apart by their length."""
    for direction in _DIRECTIONS:
        seen: dict[tuple[int, int], Command] = {}
        for command in edition.commands:
            for form in command.forms(direction):
                length = sum(size(field.type) for field in form)
                first = seen.setdefault((command.id, length), command)
                if first is not command:
                    message = (
                        f"the {direction} of {command.name} has the id {command.id:#04x} and "
                        f"{length} data bytes, as {first.name} has at {first.place}"
                    )
                    yield Problem(command.place, "ambiguous-layout", message)


def cases_alike(edition: Edition) -> Iterator[Problem]:
    """All cases of a field take the same number of bytes."""
    for command in edition.commands:
        for field in (*command.request, *command.reply):
            if len({size(type) for _, type in field.cases}) > 1:
                message = f"the cases of {field.name} differ in length"
                yield Problem(field.place, "uneven-cases", message)


def echoes_match(edition: Edition) -> Iterator[Problem]:
    """An echoed field is in the request, with the same type."""
    for command in edition.commands:
        asked = {field.name: field for field in command.request}
        for field in command.reply:
            if field.echo and (field.name not in asked or asked[field.name].type != field.type):
                message = f"{field.name} echoes no field of the request of {command.name}"
                yield Problem(field.place, "bad-echo", message)


def replies_decided(edition: Edition) -> Iterator[Problem]:
    """A query has a reply; a reply is a frame or a text; it has more than its echo."""
    for command in edition.commands:
        if command.safety == "query" and not command.reply and command.text is None:
            yield Problem(command.place, "mute-query", f"the query {command.name} has no reply")
        if command.reply and command.text is not None:
            message = f"{command.name} has both a reply and a reply_text"
            yield Problem(command.place, "two-replies", message)
        if command.reply and all(field.echo for field in command.reply):
            message = f"the reply of {command.name} only echoes"
            yield Problem(command.place, "empty-reply", message)


RULES = (ids_fit, payload_fits, forms_apart, cases_alike, echoes_match, replies_decided)
