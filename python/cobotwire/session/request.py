"""Requests that are validated and encoded, not yet sent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.messages import Request, Result
from cobotwire.protocol.rejection import reject_radians
from cobotwire.protocol.table import Command
from cobotwire.session import text


class EncodedRequest(NamedTuple):
    """A request as it goes over the line.

    ``arguments`` are those that a reply can repeat, with the values that it would repeat; empty
    where no reply repeats any. ``text`` follows some requests outside the frame.
    """

    command: Command
    frame: bytes
    text: bytes
    arguments: dict[str, Any]


class RequestEncoder:
    """Encodes requests; what does not depend on the arguments is computed once."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        # The commands that were used, and whether a reply can repeat arguments of theirs.
        self._commands: dict[str, tuple[Command, bool]] = {}
        # A request without arguments is always the same bytes.
        self._known: dict[str, EncodedRequest] = {}

    def encode_request(self, request: Request[Any]) -> EncodedRequest:
        """Validate and encode a typed request.

        Raises:
            UsageError: there is no such command, or an argument is not allowed.
        """
        values = request.values
        known = self._known.get(request.command)
        if known is not None and not values:
            return known
        command, _ = self._command(request.command)
        texts = None if command.request_text is None else request.text_values
        try:
            return self.encode(request.command, values, texts)
        except UsageError as error:
            raise _in_units_of_caller(error, command, request) from None

    def encode(
        self, name: str, values: Sequence[Any], text_values: Mapping[str, str] | None = None
    ) -> EncodedRequest:
        """Validate and encode a request by its command's name.

        Raises:
            UsageError: there is no such command, or an argument is not allowed.
        """
        command, can_repeat = self._command(name)
        frame = self._codec.encode(name, "request", values)
        if command.request_text is not None:
            sent_text = text.encode(command.request_text, text_values or {})
            return EncodedRequest(command, frame, sent_text, {})
        # Decoding our own frame gives the arguments as a reply would repeat them.
        message = self._codec.decode("request", frame, of=name) if can_repeat else None
        arguments = message.fields if message is not None else {}
        request = EncodedRequest(command, frame, b"", arguments)
        if not values:
            self._known[name] = request
        return request

    def _command(self, name: str) -> tuple[Command, bool]:
        found = self._commands.get(name)
        if found is None:
            command = self._codec.table.command(name)
            found = self._commands[name] = command, _can_repeat(command)
        return found


def request_of(frame: bytes, codec: Codec) -> EncodedRequest | None:
    """Return the request that a frame is; None: the edition has no such request."""
    try:
        message = codec.decode("request", frame)
    except ProtocolError:
        return None
    arguments = message.fields if _can_repeat(message.command) else {}
    return EncodedRequest(message.command, frame, b"", arguments)


def _in_units_of_caller(error: UsageError, command: Command, request: Request[Any]) -> UsageError:
    """Return the error in radians if the caller gave radians."""
    name = error.argument.partition(".")[0].partition("[")[0]
    if name not in request.fields_in_radians:
        return error
    fields = (field for variant in command.request for field in variant.fields)
    field = next(field for field in fields if field.name == name)
    return reject_radians(error, field, getattr(request, name))


def _can_repeat(command: Command) -> bool:
    """Return whether a reply can repeat arguments of its request."""
    return any(field.echo for variant in command.reply for field in variant.fields)


def as_call(request: EncodedRequest, codec: Codec) -> str:
    """Return the request as a person writes it: ``get_encoder(joint=1)``."""
    fields = codec.decode("request", request.frame, of=request.command.name).fields
    arguments = ", ".join(f"{name}={value}" for name, value in fields.items())
    return f"{request.command.name}({arguments})"


def result_of(request: Request[Result], fields: Mapping[str, Any]) -> Result:
    """Return what a client's method returns, given the decoded fields of the reply."""
    assert request.reply_type is not None, "a request that is waited for has a reply"
    result: Result = request.reply_type.from_fields(fields).result
    return result
