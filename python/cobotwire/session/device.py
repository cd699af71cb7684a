"""The answering side: what a simulated arm, or a referee, hears and says."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, Event, Frame, Message, Noise
from cobotwire.errors import ProtocolError
from cobotwire.session import text
from cobotwire.table import Command


class Asked(NamedTuple):
    """A legal request."""

    frame: Frame
    message: Message


class Malformed(NamedTuple):
    """A frame with a value that the edition does not allow."""

    frame: Frame
    error: ProtocolError


class Told(NamedTuple):
    """The text that followed a request outside its frame."""

    command: Command
    fields: dict[str, str]


DeviceEvent = Asked | Malformed | Told | Noise


class DeviceSession:
    """The conversation as the arm has it."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._framer = codec.framer("request")
        self._text_of: Command | None = None
        self._text = b""

    @property
    def pending(self) -> int:
        """Bytes of a request that is not whole yet."""
        return self._framer.pending

    def receive(self, data: bytes) -> list[DeviceEvent]:
        """Take what the line brought."""
        return self._sort(self._framer.feed(data))

    def flush(self) -> list[DeviceEvent]:
        """The line has been idle: what is not whole by now is refuted."""
        return self._sort(self._framer.flush())

    def answer(self, name: str, values: Mapping[str, Any]) -> bytes:
        """The bytes of a reply: the form that has just these fields.

        Raises:
            UsageError: the reply cannot be said.
        """
        command = self._codec.table.command(name)
        if command.text is not None:
            return text.spell(command.text, values)
        for form in command.reply:
            names = [field.name for field in form.fields]
            if set(names) == set(values):
                return self._codec.encode(name, "reply", [values[field] for field in names])
        return self._codec.encode(name, "reply", tuple(values.values()))

    def _sort(self, heard: Sequence[Event]) -> list[DeviceEvent]:
        events: list[DeviceEvent] = []
        for event in heard:
            if isinstance(event, Noise):
                events.append(event)
                events.extend(self._read_text(event.data))
            else:
                events.append(self._read(event))
        return events

    def _read(self, frame: Frame) -> DeviceEvent:
        self._text_of, self._text = None, b""
        try:
            message = self._codec.decode("request", frame.data)
        except ProtocolError as error:
            return Malformed(frame, error)
        if message.command.request_text is not None:
            self._text_of = message.command
        return Asked(frame, message)

    def _read_text(self, data: bytes) -> Iterator[Told]:
        """What looks like noise may be the text of the last request; its suffix ends it."""
        command = self._text_of
        if command is None or command.request_text is None:
            return
        self._text += data
        try:
            fields = text.read(command.request_text, self._text)
        except ProtocolError:
            return
        self._text_of, self._text = None, b""
        yield Told(command, fields)
