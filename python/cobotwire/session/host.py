"""The asking side: requests in, bytes out; bytes in, events out. Times are the caller's seconds.

One request waits at a time, since the protocol has no sequence numbers. A reply is matched by its
command id and by the arguments that it echoes. Whatever else comes is an event of its own: nothing
that was heard is dropped unseen.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from cobotwire.codec.interface import Codec, Frame, Message, Noise
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.session import text
from cobotwire.table import Command


class Answered(NamedTuple):
    """The reply that was waited for; ``message`` is None where it was text outside any frame."""

    command: Command
    fields: dict[str, Any]
    message: Message | None


class Refused(NamedTuple):
    """The reply that was waited for came, but the edition does not allow it."""

    command: Command
    error: ProtocolError


class Unasked(NamedTuple):
    """A legal frame that answers nothing that waits now."""

    frame: Frame


class Expired(NamedTuple):
    """The deadline passed."""

    command: Command
    asked_at: float


SessionEvent = Answered | Refused | Unasked | Expired | Noise


@dataclass
class _Pending:
    command: Command
    asked: dict[str, Any]
    asked_at: float
    deadline: float
    since: int
    text: bytearray
    heard_at: float | None = None


class HostSession:
    """The conversation as the asking side has it."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._framer = codec.framer("reply")
        self._pending: _Pending | None = None
        self._heard = 0

    @property
    def waiting(self) -> bool:
        """Whether a request waits for its reply."""
        return self._pending is not None

    @property
    def wake_at(self) -> float | None:
        """When :meth:`wake` must be called if nothing is heard until then; None: never."""
        pending = self._pending
        if pending is None:
            return None
        if pending.heard_at is None or pending.command.text is None:
            return pending.deadline
        silence = pending.command.text.silence_ms / 1000
        return min(pending.heard_at + silence, pending.deadline + silence)

    def request(
        self,
        name: str,
        values: Sequence[Any],
        now: float,
        timeout: float | None = None,
        text_values: Mapping[str, str] | None = None,
    ) -> bytes:
        """The bytes to send; if a reply is due, the session waits for it from now on.

        ``text_values`` are the fields of the text that follows some requests outside the frame.

        Raises:
            UsageError: the arguments are not allowed, or a request waits already. Nothing changed.
        """
        command = self._codec.table.command(name)
        if self._pending is not None:
            raise UsageError("command", name, f"nothing while {self._pending.command.name} waits")
        frame = self._codec.encode(name, "request", values)
        if command.request_text is not None:
            return frame + text.spell(command.request_text, text_values or {})
        if command.answers:
            # Our own frame, read back, gives the arguments as an echo would spell them.
            asked = self._codec.decode("request", frame).fields
            wait = command.deadline_ms / 1000 if timeout is None else timeout
            self._pending = _Pending(command, asked, now, now + wait, self._heard, bytearray())
        return frame

    def abandon(self) -> None:
        """Wait no longer for the request; its reply, should it come, will be unasked."""
        self._pending = None

    def receive(self, data: bytes, now: float) -> list[SessionEvent]:
        """Take what the line brought."""
        if self._pending is not None and data:
            self._pending.heard_at = now
        self._heard += len(data)
        return self._sort(self._framer.feed(data))

    def wake(self, now: float) -> list[SessionEvent]:
        """Let time pass: ends a text reply by silence, and a wait by its deadline."""
        pending = self._pending
        if pending is None or self.wake_at is None or now < self.wake_at:
            return []
        # What waits in the framer is refuted now, so that a frame hidden behind it still counts.
        events = self._sort(self._framer.flush())
        if self._pending is None:
            return events
        self._pending = None
        silent = pending.heard_at is not None and pending.command.text is not None
        if silent and pending.text and now < pending.deadline + self._silence(pending):
            events.append(self._read_text(pending))
        else:
            events.append(Expired(pending.command, pending.asked_at))
        return events

    @staticmethod
    def _silence(pending: _Pending) -> float:
        return pending.command.text.silence_ms / 1000 if pending.command.text else 0.0

    def _sort(self, heard: Sequence[Frame | Noise]) -> list[SessionEvent]:
        events: list[SessionEvent] = []
        for event in heard:
            if isinstance(event, Frame):
                events.append(self._match(event))
                continue
            if self._pending is not None and self._pending.command.text is not None:
                self._pending.text += event.data
            events.append(event)
        return events

    def _match(self, frame: Frame) -> SessionEvent:
        pending = self._pending
        if pending is None or frame.command != pending.command.id or not pending.command.reply:
            return Unasked(frame)
        if frame.offset < pending.since:
            # It had begun before the question was asked.
            return Unasked(frame)
        try:
            message = self._codec.decode("reply", frame.data, of=pending.command.name)
        except ProtocolError as error:
            self._pending = None
            return Refused(pending.command, error)
        fields = message.fields
        echoed = (field.name for field in message.layout.fields if field.echo)
        if any(fields[name] != pending.asked[name] for name in echoed):
            return Unasked(frame)
        self._pending = None
        return Answered(pending.command, fields, message)

    @staticmethod
    def _read_text(pending: _Pending) -> SessionEvent:
        reply = pending.command.text
        assert reply is not None
        try:
            return Answered(pending.command, dict(text.read(reply, bytes(pending.text))), None)
        except ProtocolError as error:
            return Refused(pending.command, error)
