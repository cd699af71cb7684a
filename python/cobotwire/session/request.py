"""A request that has been checked and spelt, but not sent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, Message
from cobotwire.session import text
from cobotwire.table import Command


class Request(NamedTuple):
    """``frame`` and ``text`` go over the line; ``asked`` are the arguments as an echo spells them.

    ``text`` is what follows some requests outside the frame; ``asked`` is empty where no reply
    echoes anything.
    """

    command: Command
    frame: bytes
    text: bytes
    asked: dict[str, Any]


class Requests:
    """Makes requests; what does not depend on the arguments is looked up once."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._commands = {command.name: command for command in codec.table.commands}
        # Calls without arguments are always the same bytes.
        self._known: dict[str, Request] = {}
        asking = {command.id for command in self._commands.values() if command.answers}
        self._mistakable = {c.name for c in codec.table.commands if c.ack and c.id in asking}

    def mistakable(self, command: Command) -> bool:
        """Whether its acknowledgement could be taken for the answer to some question."""
        return command.name in self._mistakable

    def prepare(
        self, name: str, values: Sequence[Any], text_values: Mapping[str, str] | None
    ) -> Request:
        """Check and spell a request.

        Raises:
            UsageError: there is no such command, or the arguments are not allowed.
        """
        known = self._known.get(name)
        if known is not None and not values:
            return known
        # The table's own look-up is slower, and tells the nearest spelling.
        command = self._commands.get(name) or self._codec.table.command(name)
        frame = self._codec.encode(name, "request", values)
        if command.request_text is not None:
            return Request(command, frame, text.spell(command.request_text, text_values or {}), {})
        # Our own frame, read back, gives the arguments as an echo would spell them.
        asked = self._codec.decode("request", frame).fields if _echoes(command) else {}
        request = Request(command, frame, b"", asked)
        if not values:
            self._known[name] = request
        return request


def _echoes(command: Command) -> bool:
    return any(field.echo for form in command.reply for field in form.fields)


def fits(message: Message, request: Request) -> bool:
    """Whether a reply of the request's command echoes the request's arguments."""
    if not request.asked:
        return True
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


def in_words(request: Request, codec: Codec) -> str:
    """The call as a person writes it: ``get_encoder(joint=1)``."""
    fields = codec.decode("request", request.frame, of=request.command.name).fields
    given = ", ".join(f"{name}={value}" for name, value in fields.items())
    return f"{request.command.name}({given})" if given else request.command.name
