"""The asking side: requests in, bytes out; bytes in, events out. Times are the caller's seconds.

One request waits at a time, since the protocol has no sequence numbers. A reply is matched by its
command id and by the arguments that it echoes. Whatever else comes is an event of its own: nothing
that was heard is dropped unseen.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from cobotwire.codec.interface import Codec, Frame, Message, Noise
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.session.debts import Debts
from cobotwire.session.echo import EchoWatch
from cobotwire.session.events import Answered, Echoed, Expired, Refused, SessionEvent, Unasked
from cobotwire.session.listening import TextListener
from cobotwire.session.request import Request, fits, prepare
from cobotwire.table import Command


@dataclass
class _Pending:
    request: Request
    asked_at: float
    deadline: float
    since: int
    text: TextListener | None
    # A copy of the question that reads as its answer.
    candidate: Message | None = None

    @property
    def command(self) -> Command:
        return self.request.command

    @property
    def wake_at(self) -> float:
        silent_at = None if self.text is None else self.text.silent_at
        if self.text is None or silent_at is None:
            return self.deadline
        # A text that has begun may be finished behind the deadline; babble may not go on for ever.
        return min(silent_at, self.deadline + self.text.silence)


class HostSession:
    """The conversation as the asking side has it."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._framer = codec.framer("reply")
        self._pending: _Pending | None = None
        self._debts = Debts(codec)
        self._echo = EchoWatch()
        self._heard = 0

    @property
    def waiting(self) -> bool:
        """Whether a request waits for its reply."""
        return self._pending is not None

    @property
    def wake_at(self) -> float | None:
        """When :meth:`wake` must be called if nothing is heard until then; None: never."""
        return None if self._pending is None else self._pending.wake_at

    def prepare(
        self, name: str, values: Sequence[Any], text_values: Mapping[str, str] | None = None
    ) -> Request:
        """Check and spell a request; nothing changes.

        ``text_values`` are the fields of the text that follows some requests outside the frame.

        Raises:
            UsageError: there is no such command, or the arguments are not allowed.
        """
        return prepare(self._codec, name, values, text_values)

    def hold_until(self, request: Request) -> float | None:
        """Until when this question must not be sent: a late answer could be taken for its own.

        Read the line until then, and until it is dry, and ask again: the late answer lifts the
        hold. A time that is past holds no longer. None: nothing of the kind is owed.
        """
        return self._debts.hold_until(request)

    def send(self, request: Request, now: float, timeout: float | None = None) -> bytes:
        """The bytes to send; if a reply is due, the session waits for it from now on.

        Raises:
            UsageError: a request waits already, or this one is held. Nothing changed.
        """
        command = request.command
        if self._pending is not None:
            waiting = self._pending.command.name
            raise UsageError("command", command.name, f"nothing while {waiting} waits")
        self._debts.forget(now)
        held = self._debts.hold_until(request)
        if held is not None:
            allowed = f"the same in {held - now:.3f} s; an answer to an earlier one may still come"
            raise UsageError("command", command.name, allowed)
        if command.answers and command.request_text is None:
            wait = command.deadline_ms / 1000 if timeout is None else timeout
            text = None if command.text is None else TextListener(command.text)
            self._pending = _Pending(request, now, now + wait, self._heard, text)
        self._echo.sent(request, self._heard)
        return request.frame + request.text

    def request(
        self,
        name: str,
        values: Sequence[Any],
        now: float,
        timeout: float | None = None,
        text_values: Mapping[str, str] | None = None,
    ) -> bytes:
        """:meth:`prepare` and :meth:`send` in one."""
        return self.send(self.prepare(name, values, text_values), now, timeout)

    def abandon(self) -> None:
        """Wait no longer for the request; its reply, should it come, will be unasked."""
        if self._pending is not None:
            self._debts.owe(self._pending.request, self._pending.asked_at)
        self._pending = None

    def receive(self, data: bytes, now: float) -> list[SessionEvent]:
        """Take what the line brought."""
        self._heard += len(data)
        return self._sort(self._framer.feed(data), now)

    def wake(self, now: float) -> list[SessionEvent]:
        """Let time pass: ends a text reply by silence, and a wait by its deadline."""
        pending = self._pending
        if pending is None or now < pending.wake_at:
            return []
        if pending.text is not None and pending.text.over(now):
            # What waits in the framer came behind the text, and is none of it.
            return [self._end_text(pending, pending.text)]
        # What waits in the framer is refuted now, so that a frame hidden behind it still counts.
        events = self._sort(self._framer.flush(), now)
        if self._pending is None or now < pending.wake_at:
            return events
        if pending.candidate is not None and not self._echo.proven:
            self._pending = None
            message = pending.candidate
            return [*events, Answered(pending.command, message.fields, message)]
        self.abandon()
        return [*events, Expired(pending.command, pending.asked_at)]

    def _end_text(self, pending: _Pending, text: TextListener) -> SessionEvent:
        self._pending = None
        try:
            return Answered(pending.command, text.read(), None)
        except ProtocolError as error:
            return Refused(pending.command, error)

    def _sort(self, heard: Sequence[Frame | Noise], now: float) -> list[SessionEvent]:
        events: list[SessionEvent] = []
        for event in heard:
            if isinstance(event, Frame):
                events.append(self._match(event))
                continue
            self._echo.hear_noise(event)
            pending = self._pending
            if pending is not None and pending.text is not None:
                # A text that had begun before the question was asked is none of ours.
                pending.text.hear(event.data[max(0, pending.since - event.offset) :], now)
            events.append(event)
        return events

    def _match(self, frame: Frame) -> SessionEvent:
        copy = self._echo.is_copy(frame)
        pending = self._pending
        if (
            pending is None
            or frame.command != pending.command.id
            or not pending.command.reply
            # It had begun before the question was asked.
            or frame.offset < pending.since
        ):
            self._debts.settle(frame)
            return Unasked(frame)
        try:
            message = self._codec.decode("reply", frame.data, of=pending.command.name)
        except ProtocolError as error:
            return self._refuse(pending, frame, copy, error)
        if copy:
            return self._weigh_copy(pending, frame, message)
        if not fits(message, pending.request):
            self._debts.settle(frame)
            return Unasked(frame)
        self._pending = None
        return Answered(pending.command, message.fields, message)

    def _weigh_copy(self, pending: _Pending, frame: Frame, message: Message) -> SessionEvent:
        """See :mod:`cobotwire.session.echo`."""
        if fits(message, pending.request):
            pending.candidate = message
        else:
            self._echo.proven = True
        return Echoed(frame)

    def _refuse(
        self, pending: _Pending, frame: Frame, copy: bool, error: ProtocolError
    ) -> SessionEvent:
        """An answer that the edition rules out; unless it is no answer, or another question's."""
        if copy:
            self._echo.proven = True
            return Echoed(frame)
        if self._debts.any_of(frame.command):
            return Unasked(frame)
        self._pending = None
        return Refused(pending.command, error)
