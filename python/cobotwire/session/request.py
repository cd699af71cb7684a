"""Requests that are validated and encoded, not yet sent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, Frame
from cobotwire.protocol.addresses import (
    NOBODY,
    address_name,
    find_address,
    lacks_joints,
    replier_of,
)
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.messages import Request, Result
from cobotwire.protocol.rejection import reject_radians
from cobotwire.protocol.table import Address, Command
from cobotwire.session import text


class EncodedRequest(NamedTuple):
    """A request as it goes over the line.

    ``arguments`` are the arguments that a reply repeats, with their values; empty if no reply
    repeats any. ``text`` follows some frames. ``replier`` is the address that its reply must have,
    or who replies to a broadcast (ANYBODY, SOMEBODY, NOBODY); None if frames have no address.
    Without ``reply_has_id`` its reply is known only by address and size.
    """

    command: Command
    frame: bytes
    text: bytes
    arguments: dict[str, Any]
    replier: int | None = None
    reply_has_id: bool = True

    def can_have_reply(self, frame: Frame) -> bool:
        """Return whether a frame can be a reply of this command, whatever its values.

        The command id decides; in a format without ids in replies, the size does.
        """
        if self.reply_has_id:
            return frame.command == self.command.id
        try:
            frame.decode("reply", of=self.command.name)
        except ProtocolError as error:
            return error.reason == "bad-value"
        return True


class RequestEncoder:
    """Encodes requests to one address; what does not depend on the arguments is computed once."""

    def __init__(self, codec: Codec, address: Address | None = None) -> None:
        """Take the address of every request; by default the edition's first one, if it has any."""
        self._codec = codec
        self._to = address or find_address(codec.table, None)
        self._address = None if self._to is None else self._to.value
        self._replier = replier_of(self._to)
        self._reply_has_id = codec.table.frame.reply_has_id
        # The commands that were used, each with whether a reply can repeat its arguments.
        self._commands: dict[str, tuple[Command, bool]] = {}
        # A request without arguments is always the same bytes.
        self._known: dict[str, EncodedRequest] = {}

    def encode_request(self, request: Request[Any]) -> EncodedRequest:
        """Validate and encode a typed request.

        Raises:
            UsageError: there is no such command, or an argument is not allowed.
        """
        known = self._known.get(request.command)
        if known is not None and (request.fieldless or not request.values):
            return known
        command, _ = self._command(request.command)
        texts = None if command.request_text is None else request.text_values
        try:
            return self.encode(request.command, request.values, texts, request.variant_index)
        except UsageError as error:
            raise _in_units_of_caller(error, command, request) from None

    def queries_before(self, request: EncodedRequest) -> Sequence[Command]:
        """Return the queries of which each must report 0 before the request may be sent."""
        return ()

    def accept_frame(self) -> None:
        """Record that each of these queries has reported 0."""

    def encode(
        self,
        name: str,
        values: Sequence[Any],
        text_values: Mapping[str, str] | None = None,
        variant: int | None = None,
    ) -> EncodedRequest:
        """Validate and encode a request by its command's name.

        Without ``variant``, the first variant with that number of values that allows them is used.

        Raises:
            UsageError: there is no such command, or an argument is not allowed.
        """
        command, can_repeat = self._command(name)
        frame = self._codec.encode(name, "request", values, variant=variant, address=self._address)
        if command.request_text is not None:
            sent_text = text.encode(command.request_text, text_values or {})
            return EncodedRequest(command, frame, sent_text, {}, self._replier, self._reply_has_id)
        # Decoding our own frame gives the arguments as a reply would repeat them.
        message = self._codec.decode("request", frame, of=name) if can_repeat else None
        arguments = message.fields if message is not None else {}
        request = EncodedRequest(command, frame, b"", arguments, self._replier, self._reply_has_id)
        if not values:
            self._known[name] = request
        return request

    def _command(self, name: str) -> tuple[Command, bool]:
        found = self._commands.get(name)
        if found is None:
            command = self._codec.table.command(name)
            if self._replier == NOBODY and command.requires_reply:
                raise _unanswered(name, self._to)
            why = lacks_joints(self._codec.table, self._to, command)
            if why and self._to is not None:
                message = f"{name}() {why}"
                raise UsageError("address", self._to.name, message=message)
            found = self._commands[name] = command, _can_repeat(command)
        return found


def request_of(frame: bytes, codec: Codec) -> EncodedRequest | None:
    """Return the request that a frame is; None: the edition has no such request."""
    try:
        message = codec.decode("request", frame)
    except ProtocolError:
        return None
    arguments = message.fields if _can_repeat(message.command) else {}
    replier = replier_of(find_address(codec.table, message.address))
    has_id = codec.table.frame.reply_has_id
    return EncodedRequest(message.command, frame, b"", arguments, replier, has_id)


def check_acknowledged(request: EncodedRequest) -> None:
    """Check that the acknowledgement of a request can be waited for.

    Raises:
        UsageError: no device acknowledges a request to its address.
    """
    if request.replier == NOBODY:
        message = error_text("unacknowledged", command=request.command.name)
        raise UsageError("ack_within", message=message)


def _unanswered(name: str, address: Address | None) -> UsageError:
    assert address is not None, "only an address can have no replies"
    message = error_text("unanswered", command=name, name=address.name)
    return UsageError("address", address.name, message=message)


def _in_units_of_caller(error: UsageError, command: Command, request: Request[Any]) -> UsageError:
    """Return the error in radians if the caller gave radians."""
    name = error.argument.partition(".")[0].partition("[")[0]
    if name not in request.fields_in_radians():
        return error
    fields = (field for variant in command.request for field in variant.fields)
    field = next(field for field in fields if field.name == name)
    return reject_radians(error, field, getattr(request, name))


def _can_repeat(command: Command) -> bool:
    """Return whether a reply can repeat arguments of its request."""
    return any(field.echo for variant in command.reply for field in variant.fields)


def as_call(request: EncodedRequest, codec: Codec) -> str:
    """Return the request as a person writes it: ``get_encoder(joint=1)``, ``stop() to LEFT``."""
    message = codec.decode("request", request.frame, of=request.command.name)
    arguments = ", ".join(f"{name}={value}" for name, value in message.fields.items())
    to = "" if message.address is None else f" to {address_name(codec.table, message.address)}"
    return f"{request.command.name}({arguments}){to}"


def result_of(request: Request[Result], fields: Mapping[str, Any]) -> Result:
    """Return what a client's method returns, given the decoded fields of the reply."""
    assert request.reply_type is not None, "a request that is waited for has a reply"
    result: Result = request.reply_type.result_from(fields)
    return result
