"""The asking side: requests in, bytes out; bytes in, events out. Times are the caller's seconds.

One request waits at a time, since the protocol has no sequence numbers. A reply is matched by its
command id and by the arguments that it echoes. Whatever else comes is an event of its own: nothing
that was heard is dropped unseen.

A reply that comes twice answers once: a copy that has begun before the next question is sent is
unasked. A copy that begins later can be told from that question's answer only by its arguments.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cobotwire.codec.interface import Codec, Frame, Noise
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.session.acks import Due
from cobotwire.session.events import Answered, Expired, Refused, SessionEvent
from cobotwire.session.listening import TextListener
from cobotwire.session.matching import Matcher
from cobotwire.session.pending import Pending
from cobotwire.session.policy import ASK_ONCE, RetryPolicy
from cobotwire.session.request import Request, Requests


class HostSession:
    """The conversation as the asking side has it, one question at a time."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._framer = codec.framer("reply")
        self._requests = Requests(codec)
        self._pending: Pending | None = None
        self._grace = ASK_ONCE.grace
        self._matcher = Matcher(codec)
        self._debts = self._matcher.debts
        self._acks = self._matcher.acks
        self._echo = self._matcher.echo
        self._heard = 0

    @property
    def waiting(self) -> bool:
        """Whether a request waits for its reply."""
        return self._pending is not None

    @property
    def wake_at(self) -> float | None:
        """When :meth:`wake` must be called if nothing is heard until then; None: never."""
        return None if self._pending is None else self._pending.over_at

    @property
    def next_at(self) -> float | None:
        """When something is to be done, if nothing is heard until then; None: never."""
        pending = self._pending
        if pending is None:
            return None
        again_at = self.again_at
        return pending.over_at if again_at is None else min(pending.over_at, again_at)

    @property
    def again_at(self) -> float | None:
        """When the question that waits is to be asked :meth:`again`; None: not again."""
        pending = self._pending
        if pending is None or (pending.candidate is not None and not self._echo.proven):
            return None
        return pending.again_at

    @property
    def echoes(self) -> bool:
        """Whether the line was seen to send our own bytes back."""
        return self._echo.proven

    def prepare(
        self, name: str, values: Sequence[Any], text_values: Mapping[str, str] | None = None
    ) -> Request:
        """Check and spell a request; nothing changes.

        ``text_values`` are the fields of the text that follows some requests outside the frame.

        Raises:
            UsageError: there is no such command, or the arguments are not allowed.
        """
        return self._requests.prepare(name, values, text_values)

    def hold_until(self, request: Request) -> float | None:
        """Until when this question must not be sent: a late answer could be taken for its own.

        Read the line until then, and until it is dry, and ask again: the late answer lifts the
        hold. A time that is past holds no longer. None: nothing of the kind is owed.
        """
        return self._debts.hold_until(request)

    def send(
        self,
        request: Request,
        now: float,
        timeout: float | None = None,
        policy: RetryPolicy = ASK_ONCE,
    ) -> bytes:
        """The bytes to send; if a reply is due, the session waits for it from now on.

        Raises:
            UsageError: a question waits already, or this one is held. Nothing changed.
        """
        command = request.command
        if not command.answers:
            return self.order(request, now)[0]
        if self._pending is not None:
            waiting = self._pending.command.name
            raise UsageError("command", command.name, f"nothing while {waiting} waits")
        self._debts.forget(now)
        held = self._debts.hold_until(request)
        if held is not None:
            allowed = f"the same in {held - now:.3f} s; an answer to an earlier one may still come"
            raise UsageError("command", command.name, allowed)
        wait = command.deadline_ms / 1000 if timeout is None else timeout
        self._grace = policy.grace
        self._echo.sent(request, self._heard)
        self._pending = Pending(request, now, wait, policy.tries_of(command, wait), self._heard)
        return request.frame

    def order(self, request: Request, now: float, wait: float = 0.0) -> tuple[bytes, Due | None]:
        """The bytes of an order, which may go out at any time, and once only.

        The second is its acknowledgement, if the edition has one; it is expected for ``wait``
        seconds at least.
        """
        self._echo.sent(request, self._heard)
        due = None
        if request.command.ack:
            due = self._acks.expect(request, now, wait, self._heard)
            if self._requests.mistakable(request.command):
                self._debts.owe(request, due.until)
        return request.frame + request.text, due

    def again(self, now: float) -> bytes:
        """The bytes of the question that waits, to be sent once more: see :attr:`again_at`."""
        pending = self._pending
        if pending is None:
            return b""
        pending.asked.append(now)
        self._echo.sent(pending.request, self._heard, again=True)
        return pending.request.frame

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
        """Wait no longer for the request; its reply, should it come, will be late."""
        pending = self._pending
        if pending is not None:
            for asked_at in pending.asked:
                self._debts.owe(pending.request, asked_at + self._grace)
        self._pending = None

    def receive(self, data: bytes, now: float) -> list[SessionEvent]:
        """Take what the line brought."""
        self._heard += len(data)
        return self._sort(self._framer.feed(data), now)

    def wake(self, now: float) -> list[SessionEvent]:
        """Let time pass: ends a text reply by silence, and a wait by its deadline."""
        pending = self._pending
        if pending is None or now < pending.over_at:
            return []
        if pending.text is not None and pending.text.over(now):
            # What waits in the framer came behind the text, and is none of it.
            return [self._end_text(pending, pending.text)]
        # What waits in the framer is refuted now, so that a frame hidden behind it still counts.
        events = self._sort(self._framer.flush(), now)
        if self._pending is None or now < pending.over_at:
            return events
        if pending.candidate is not None and not self._echo.proven:
            self._settled(pending)
            message = pending.candidate
            return [*events, Answered(pending.command, message.fields, message)]
        self.abandon()
        return [*events, Expired(pending.command, pending.asked[0], len(pending.asked))]

    def _settled(self, pending: Pending) -> None:
        """One reply came; the others, where it was asked more than once, may still come."""
        for asked_at in pending.asked[1:]:
            self._debts.owe(pending.request, asked_at + self._grace)
        self._pending = None

    def _end_text(self, pending: Pending, text: TextListener) -> SessionEvent:
        self._pending = None
        try:
            return Answered(pending.command, text.read(), None)
        except ProtocolError as error:
            return Refused(pending.command, error)

    def _sort(self, heard: Sequence[Frame | Noise], now: float) -> list[SessionEvent]:
        events: list[SessionEvent] = []
        for event in heard:
            if isinstance(event, Frame):
                events.append(self._match(event, now))
                continue
            pending = self._pending
            self._echo.hear_noise(event)
            if pending is not None and pending.text is not None:
                # A text that had begun before the question was asked is none of ours.
                pending.text.hear(event.data[max(0, pending.since - event.offset) :], now)
            events.append(event)
        return events

    def _match(self, frame: Frame, now: float) -> SessionEvent:
        pending = self._pending
        event = self._matcher.match(frame, pending, now)
        if pending is not None and isinstance(event, (Answered, Refused)):
            self._settled(pending)
        return event
