"""The answering side: what a simulated arm, or a referee, hears and says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, Event, Frame, Message, Noise
from cobotwire.errors import ProtocolError
from cobotwire.session import text


class Asked(NamedTuple):
    """A legal request."""

    frame: Frame
    message: Message


class Malformed(NamedTuple):
    """A frame with a value that the edition does not allow."""

    frame: Frame
    error: ProtocolError


DeviceEvent = Asked | Malformed | Noise


class DeviceSession:
    """The conversation as the arm has it."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._framer = codec.framer("request")

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
        return [event if isinstance(event, Noise) else self._read(event) for event in heard]

    def _read(self, frame: Frame) -> DeviceEvent:
        try:
            return Asked(frame, self._codec.decode("request", frame.data))
        except ProtocolError as error:
            return Malformed(frame, error)
