"""The device side of the exchange: what a simulated arm receives and replies."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, DecodedMessage, Event, Frame, Noise
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Command
from cobotwire.session import text


class RequestReceived(NamedTuple):
    """A legal request."""

    frame: Frame
    message: DecodedMessage


class MalformedRequest(NamedTuple):
    """A request with a value that the edition does not allow."""

    frame: Frame
    error: ProtocolError


class TextReceived(NamedTuple):
    """The text that followed a request outside its frame."""

    command: Command
    fields: dict[str, str]
    address: int | None = None


DeviceEvent = RequestReceived | MalformedRequest | TextReceived | Noise


class DeviceSession:
    """Sorts received bytes into requests, texts and noise; encodes replies."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._framer = codec.framer("request")
        self._text_of: Command | None = None
        self._text_to: int | None = None
        self._text = b""

    @property
    def pending(self) -> int:
        """How many bytes of an unfinished request were received."""
        return self._framer.pending

    def receive(self, data: bytes) -> list[DeviceEvent]:
        """Take received bytes; return what they are."""
        return self._sort(self._framer.feed(data))

    def flush(self) -> list[DeviceEvent]:
        """Give up an unfinished request, since the line is idle; return its bytes as events."""
        return self._sort(self._framer.flush())

    def encode_reply(
        self, name: str, values: Mapping[str, Any], address: int | None = None
    ) -> bytes:
        """Return the bytes of a reply: the first variant with these fields that allows the values.

        ``address`` is that of the device; None: the edition's first one, if it has addresses.

        Raises:
            UsageError: the edition does not allow this reply.
        """
        command = self._codec.table.command(name)
        if command.text is not None:
            return text.encode(command.text, values)
        rejection: UsageError | None = None
        for index, variant in enumerate(command.reply):
            names = [field.name for field in variant.fields]
            if set(names) == set(values):
                given = [values[field] for field in names]
                try:
                    return self._codec.encode(name, "reply", given, variant=index, address=address)
                except UsageError as error:
                    rejection = rejection or error
        if rejection is not None:
            raise rejection
        return self._codec.encode(name, "reply", tuple(values.values()), address=address)

    def _sort(self, received: Sequence[Event]) -> list[DeviceEvent]:
        events: list[DeviceEvent] = []
        for event in received:
            if isinstance(event, Noise):
                events.append(event)
                events.extend(self._read_text(event.data))
            else:
                events.append(self._read(event))
        return events

    def _read(self, frame: Frame) -> DeviceEvent:
        self._text_of, self._text = None, b""
        try:
            message = frame.decode("request")
        except ProtocolError as error:
            return MalformedRequest(frame, error)
        if message.command.request_text is not None:
            self._text_of, self._text_to = message.command, message.address
        return RequestReceived(frame, message)

    def _read_text(self, data: bytes) -> Iterator[TextReceived]:
        """Yield the text of the last request, which looks like noise; its suffix ends it."""
        command = self._text_of
        if command is None or command.request_text is None:
            return
        self._text += data
        try:
            fields = text.decode(command.request_text, self._text)
        except ProtocolError:
            return
        self._text_of, self._text = None, b""
        yield TextReceived(command, fields, self._text_to)
