"""Whose turn it is: one request waits for its reply at a time, and the others queue.

They queue in the order of submission; one that is held for an outstanding reply is overtaken. The
time to reply runs from the first sending, so that it measures the arm's silence and not the queue.
A caller's deadline runs from the call: a request that was not sent by then is never sent.
"""

from __future__ import annotations

from math import inf

from cobotwire.codec.interface import Codec, Framer
from cobotwire.protocol.errors import LinkError, ReplyTimeout, WaitedFor
from cobotwire.session.alignment import Alignment
from cobotwire.session.echo import EchoDetector
from cobotwire.session.events import RequestExpired, SessionEvent
from cobotwire.session.outstanding import OutstandingReplies
from cobotwire.session.pending import PendingRequest
from cobotwire.session.request import as_call

# For how long received bytes are read before a request is sent, if they do not end.
DRAIN_SECONDS = 0.05
NOT_SENT = "more than can be read; a late reply may be among it"


class Turns:
    """The requests that wait for their turn, and the one that waits for its reply.

    Attributes:
        queue: what waits for its turn, oldest first; an interrupt may leave in it what is done, or
            was sent.
        last: the request that was sent last; it waits for its reply unless it is done.
        line_is_full: whether the line took no bytes when the next request was to be sent.
    """

    def __init__(
        self,
        codec: Codec,
        framer: Framer,
        alignment: Alignment,
        outstanding: OutstandingReplies,
        echo: EchoDetector,
    ) -> None:
        self._codec, self._framer = codec, framer
        self._alignment, self._outstanding, self._echo = alignment, outstanding, echo
        self.queue: list[PendingRequest] = []
        self.last: PendingRequest | None = None
        self.line_is_full = False

    def waiting(self) -> PendingRequest | None:
        """Return the request that waits for its reply."""
        last = self.last
        return None if last is None or last.done else last

    def drop_done(self) -> None:
        """Forget the queued requests that are done."""
        self.queue = [pending for pending in self.queue if not pending.done]

    def fail_waiting(self, error: LinkError) -> None:
        """End the request that waits with an error; its reply may come all the same."""
        waiting = self.waiting()
        if waiting is not None:
            self._outstanding.expect_late(waiting, 0)
            waiting.fail(error)

    def end_overdue(self, now: float) -> list[SessionEvent]:
        """End the requests of callers that wait no longer; return what happened to a sent one."""
        if any(pending.ends_by <= now for pending in self.queue):
            for pending, free_at in self._free_times(now):
                if pending.ends_by <= now:
                    full: WaitedFor = "line" if self.line_is_full else "turn"
                    waited_for = "hold" if free_at > now else full
                    pending.expire(self._codec, now - pending.queued_at, 0, waited_for)
            self.drop_done()
        waiting = self.waiting()
        if waiting is None or waiting.ends_by > now:
            return []
        attempts, requested_at = len(waiting.attempt_times), waiting.requested_at
        # A copy of it does not count as its reply: that one still had time to come.
        self._outstanding.expect_late(waiting, 0)
        waiting.expire(self._codec, now - waiting.queued_at, attempts, "reply")
        return [RequestExpired(waiting.request.command, requested_at, attempts)]

    def begin(self, pending: PendingRequest, now: float) -> bytes:
        """Return the bytes of a request if nothing else is under way; otherwise queue it."""
        held = self.queue or self._outstanding.replies or pending.ends_by <= now
        if held or self.waiting() is not None:
            self.queue.append(pending)
            return b""
        self._begin(pending, now)
        return pending.request.frame

    def next(self, now: float, drained: bool) -> bytes:
        """Return the bytes of the request to be sent now, for the first time or again.

        ``drained``: whether everything that has come by now was received.
        """
        waiting = self.waiting()
        if waiting is not None:
            return self._next_attempt(waiting, now)
        for pending, free_at in self._free_times(now):
            if free_at <= now < pending.ends_by:
                break
        else:
            return b""
        if not drained:
            # A line that brings more than can be read is never drained.
            if pending.undrained(now) < DRAIN_SECONDS:
                return b""
            if self._outstanding.held_until(pending.request) is not None:
                self._refuse_to_send(pending, now)
                return b""
        if self._outstanding.replies:
            self._outstanding.drop_expired(now)
        self._begin(pending, now)
        self.queue.remove(pending)
        return pending.request.frame

    def has_next(self, now: float) -> bool:
        """Return whether :meth:`next` may have something to send."""
        waiting = self.waiting()
        if waiting is None:
            return bool(self.queue)
        repeat_at = self._repeat_at(waiting)
        return repeat_at is not None and repeat_at <= now

    def next_at(self, now: float) -> float:
        """Return when something is to be sent, or a wait ends, unless bytes come; inf: never."""
        waiting, soonest = self.waiting(), inf
        if self.queue:
            soonest = min([pending.ends_by for pending in self._queued()], default=inf)
        if waiting is None:
            return min([soonest, *(free_at for _, free_at in self._free_times(now))])
        soonest, repeat_at = (
            min(soonest, waiting.ends_at, waiting.ends_by),
            self._repeat_at(waiting),
        )
        return soonest if repeat_at is None or repeat_at >= soonest else repeat_at

    def free_at(self, pending: PendingRequest, now: float) -> float:
        """Return from when on no late reply can be mistaken for the request's."""
        if not self._outstanding.replies:
            return now
        held_until = self._outstanding.held_until(pending.request)
        return now if held_until is None else held_until

    def _free_times(self, now: float) -> list[tuple[PendingRequest, float]]:
        """Return each queued request, and from when on it may be sent."""
        queued = self._queued()
        # Many callers may want the same.
        alike = {pending.request.frame: pending for pending in queued}
        known = {frame: self.free_at(pending, now) for frame, pending in alike.items()}
        return [(pending, known[pending.request.frame]) for pending in queued]

    def _begin(self, pending: PendingRequest, now: float) -> None:
        request, fed = pending.request, self._framer.fed
        self._echo.sent(request, fed)
        pending.begin(now, fed)
        self.last, self._alignment.last_request = pending, request.frame

    def _queued(self) -> list[PendingRequest]:
        return [p for p in self.queue if not p.done and p is not self.last]

    def _repeat_at(self, waiting: PendingRequest) -> float | None:
        """Return when the request is to be sent again; not while its copy may be its reply."""
        if waiting.candidate is not None and not self._echo.proven:
            return None
        return waiting.repeat_at

    def _next_attempt(self, waiting: PendingRequest, now: float) -> bytes:
        repeat_at = self._repeat_at(waiting)
        if repeat_at is None or not repeat_at <= now < waiting.ends_by:
            return b""
        self._echo.sent_again()
        waiting.repeat(now)
        return waiting.request.frame

    def _refuse_to_send(self, pending: PendingRequest, now: float) -> None:
        """End a request: the late reply that holds it may be among the bytes not read yet."""
        request, waited = pending.request, now - pending.queued_at
        call = as_call(request, self._codec)
        pending.fail(ReplyTimeout(request.command.name, waited, (NOT_SENT,), 0, call))
        self.drop_done()
