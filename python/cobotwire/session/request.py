"""A request that has been checked and spelt, but not sent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, Message
from cobotwire.session import text
from cobotwire.table import Command


class Request(NamedTuple):
    """``frame`` and ``text`` go over the line; ``asked`` are the arguments as an echo spells them.

    ``text`` is what follows some requests outside the frame; ``asked`` is empty where nothing is
    due in return.
    """

    command: Command
    frame: bytes
    text: bytes
    asked: dict[str, Any]


def prepare(
    codec: Codec, name: str, values: Sequence[Any], text_values: Mapping[str, str] | None
) -> Request:
    """Check and spell a request.

    Raises:
        UsageError: there is no such command, or the arguments are not allowed.
    """
    command = codec.table.command(name)
    frame = codec.encode(name, "request", values)
    if command.request_text is not None:
        return Request(command, frame, text.spell(command.request_text, text_values or {}), {})
    # Our own frame, read back, gives the arguments as an echo would spell them.
    asked = codec.decode("request", frame).fields if command.answers else {}
    return Request(command, frame, b"", asked)


def fits(message: Message, request: Request) -> bool:
    """Whether a reply of the request's command echoes the request's arguments."""
    echoed = (field.name for field in message.layout.fields if field.echo)
    fields = message.fields
    return all(request.asked.get(name, fields[name]) == fields[name] for name in echoed)


def told_apart(one: Request, other: Request) -> bool:
    """Whether no reply to one could be taken for a reply to the other."""
    command = other.command
    if one.command.id != command.id:
        return True
    if one.command.name != command.name or not command.reply:
        return False
    # Older firmware leaves the echo out: every form of the reply must tell.
    return all(
        any(field.echo and _differ(field.name, one, other) for field in form.fields)
        for form in command.reply
    )


def _differ(name: str, one: Request, other: Request) -> bool:
    return name in one.asked and name in other.asked and one.asked[name] != other.asked[name]
