"""The exchange of requests and replies over one transport, shared by many callers.

This is the session's state machine. It has no clock, thread or port: bytes and times go in, bytes
and events come out, and clients differ only in how they wait.

A request that has a reply passes through three states::

    queued ──outgoing()──▶ waiting ──reply, error or deadline──▶ done
       │                      │ ▲
       │                      └─┘ outgoing(), for another attempt
       └───────────────── give_up(), fail() ───────────────────▶ done

Only one request waits at a time, since the protocol has no sequence numbers. The others queue in
the order of submission; one that is held for an outstanding reply is overtaken. The deadline runs
from the first sending, so that it measures the arm's silence and not the queue.

One-way requests (settings, motion: whatever has no reply) take no turns. They are sent at once, and
only once, also while another request waits.

Ctrl-C can interrupt any step in a client's thread. So each step commits with a single assignment:
``done`` ends a request, ``_last`` makes it the one that waits. What an interrupt leaves in the
lists besides is skipped.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

from cobotwire.codec.interface import Codec, Event, Frame, Noise
from cobotwire.protocol.addresses import ANYBODY, NOBODY
from cobotwire.protocol.errors import LinkError, ProtocolError, ReplyTimeout
from cobotwire.protocol.shared import once_per_table
from cobotwire.protocol.table import Table
from cobotwire.session.acks import Acks, PendingAck
from cobotwire.session.alignment import Alignment
from cobotwire.session.echo import EchoDetector
from cobotwire.session.events import (
    ReplyMatched,
    ReplyRejected,
    RequestExpired,
    SessionEvent,
)
from cobotwire.session.leftover import LateFrame, Leftover
from cobotwire.session.matching import can_come_from, repeats_arguments, replies_elsewhere
from cobotwire.session.other_frames import OtherFrames
from cobotwire.session.outstanding import OutstandingReplies, OutstandingReply, late_replies
from cobotwire.session.pending import Pending, PendingRequest
from cobotwire.session.policy import RetryPolicy
from cobotwire.session.request import EncodedRequest, as_call, request_of

# For how long received bytes are read before a request is sent, if they do not end.
DRAIN_SECONDS = 0.05
NOT_SENT = "more than can be read; a late reply may be among it"

# A request that is alone on its line: when it began, how many bytes had been fed by then, and for
# how many seconds after that its late reply is expected.
Alone = tuple[EncodedRequest, float, int, float]


@once_per_table
def _replying_ids(table: Table) -> frozenset[int]:
    return frozenset(command.id for command in table.commands if command.requires_reply)


class Exchange:
    """Requests that take turns, one-way requests, and the frames that come back."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self.framer = codec.framer("reply")
        self._format = codec.table.frame
        self._replying_ids = _replying_ids(codec.table)
        self.alignment = Alignment(codec)
        self._sent_last = b""
        # Where in the stream the bytes began that were received last.
        self._chunk_at = 0
        self._queue: list[PendingRequest] = []
        # The request that was sent last; it waits for its reply unless it is done.
        self._last: PendingRequest | None = None
        self._alone: Alone | None = None
        self._outstanding = OutstandingReplies()
        self._acks = Acks(codec)
        self._echo = EchoDetector()
        self._others = OtherFrames(codec.table, self._outstanding, self._acks, self._echo)

    # What callers want.

    def submit(
        self, request: EncodedRequest, now: float, policy: RetryPolicy, wait: float | None = None
    ) -> PendingRequest:
        """Queue a request; ``wait`` is its deadline in seconds, None: that of the edition."""
        pending = PendingRequest(request, wait, policy, now)
        self.enqueue(pending)
        return pending

    def enqueue(self, pending: PendingRequest) -> None:
        """Queue a request whose caller already holds it, and gives it up in any case."""
        self._queue.append(pending)

    def send_one_way(
        self, request: EncodedRequest, now: float, ack_within: float | None = None
    ) -> tuple[bytes, PendingAck | None]:
        """Return the bytes of a one-way request, to be written now.

        The second is there if ``ack_within`` says how many seconds its acknowledgement is waited
        for, and the edition has one.
        """
        self._echo.sent_one_way(request, self.framer.fed)
        self._sent_last = request.frame
        if not request.command.ack or request.replier == NOBODY:
            return request.frame + request.text, None
        ack, pending = self._acks.expect(request, now, self.framer.fed, ack_within)
        if request.command.id in self._replying_ids:
            self._outstanding.expect(request, ack.until)
        return request.frame + request.text, pending

    def give_up(self, pending: Pending) -> None:
        """End a request whose caller waits no longer. A reply that still comes is late."""
        if pending.done:
            return
        if isinstance(pending, PendingRequest):
            self._outstanding.expect_late(pending, 0)
        pending.cancel()
        self._drop_done()

    def fail(self, error: LinkError, now: float) -> list[SessionEvent]:
        """End every request: the transport is gone.

        Returns:
            What the bytes are that still waited: what comes after the transport is open again does
            not complete them.
        """
        events = self._sort(self.framer.flush(), now)
        if self._sent_last:
            self.alignment.lose(self._sent_last)
            self._sent_last = b""
        self.fail_waiting(error)
        for pending in self._queue:
            if not pending.done:
                pending.fail(error)
        self._drop_done()
        self._acks.fail(error)
        return events

    def fail_waiting(self, error: LinkError) -> None:
        """End the request that waits: the bytes that :meth:`outgoing` gave were not written."""
        waiting = self._waiting()
        if waiting is not None:
            self._outstanding.expect_late(waiting, 0)
            waiting.fail(error)

    # What one session leaves to the next one on its port.

    def leave(self, now: float) -> Leftover:
        """Return what the next session on this port must respect."""
        waiting = self._waiting()
        replies = [reply for reply in self._outstanding.replies if reply.until > now]
        if waiting is not None:
            replies += late_replies(waiting, 0)
        if self._alone is not None:
            request, sent_at, _, grace = self._alone
            replies.append(OutstandingReply(request, sent_at + grace))
        late = (LateFrame(reply.request.frame, reply.until) for reply in replies)
        return Leftover(tuple(late), self.alignment.held)

    def take_over(self, leftover: Leftover) -> None:
        """Respect what an earlier session left on this port."""
        for late in leftover.late:
            request = request_of(late.request, self._codec)
            if request is not None:
                self._outstanding.expect(request, late.until)
        if leftover.parts:
            self.alignment.hold(leftover.parts)

    # What the client's loop does.

    def advance(self, data: bytes, now: float) -> tuple[list[SessionEvent], bool]:
        """Take received bytes, then let time pass: :meth:`receive` and :meth:`wake`.

        What has come is received before time passes, or it would count as late.

        Returns:
            What happened, and what :meth:`has_outgoing` returns now.
        """
        events = self.receive(data, now) if data else []
        last = self._last
        if last is None or last.done:
            # So it is after each reply.
            if self._acks.waiting:
                self._acks.wake(now, self._echo.proven)
            return events, bool(self._queue)
        events += self.wake(now)
        return events, self.has_outgoing(now)

    def receive(self, data: bytes, now: float) -> list[SessionEvent]:
        """Take received bytes; return what they are."""
        self._chunk_at = self.framer.fed
        events = self.framer.feed(data)
        return self._sort(events, now) if events else []

    def wake(self, now: float) -> list[SessionEvent]:
        """Let time pass; return what ends by it. Receive first what has come by now."""
        waiting = self._waiting()
        events = self._end_wait(waiting, now) if waiting and waiting.ends_at <= now else []
        if self._acks.waiting:
            self._acks.wake(now, self._echo.proven)
        return events

    def idle_seconds(self, now: float) -> float | None:
        """Return for how long nothing is to be done unless bytes come; None: without end."""
        waiting = self._waiting()
        if waiting is not None:
            soonest, repeat_at = waiting.ends_at, self._repeat_at(waiting)
            if repeat_at is not None and repeat_at < soonest:
                soonest = repeat_at
        elif self._queue:
            soonest = min([self._free_at(p, now) for p in self._queued()], default=inf)
        else:
            soonest = inf
        if self._acks.waiting:
            soonest = min(soonest, self._acks.next_end)
        return None if soonest == inf else max(0.0, soonest - now)

    def has_outgoing(self, now: float) -> bool:
        """Return whether :meth:`outgoing` may have something to send."""
        waiting = self._waiting()
        if waiting is None:
            return bool(self._queue)
        repeat_at = self._repeat_at(waiting)
        return repeat_at is not None and repeat_at <= now

    @property
    def sent_last(self) -> PendingRequest | None:
        """The request that :meth:`outgoing` gave last; it may be done by now."""
        return self._last

    def written(self, pending: PendingRequest, now: float) -> None:
        """Note that writing a request ended only now: its reply may be late from now on."""
        if pending.done:
            self._outstanding.expect(pending.request, now + pending.policy.grace)
        else:
            pending.written(now)

    def outgoing(self, now: float, drained: bool) -> bytes:
        """Return the bytes of the request to be sent now, for the first time or again.

        ``drained``: whether everything that has come by now was received. A request is sent on a
        drained line, so that earlier bytes cannot pass for its reply.
        """
        self.settle()
        waiting = self._waiting()
        if waiting is not None:
            return self._next_attempt(waiting, now)
        for pending in self._queued():
            if self._free_at(pending, now) <= now:
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
        self._queue.remove(pending)
        return pending.request.frame

    def begin(self, pending: PendingRequest, now: float) -> bytes:
        """Return the bytes of a request if nothing else is under way; otherwise queue it.

        Everything that has come by now was received. This is :meth:`enqueue` and :meth:`outgoing`
        in one step.
        """
        self.settle()
        if self._waiting() is not None or self._queue or self._outstanding.replies:
            self._queue.append(pending)
            return b""
        self._begin(pending, now)
        return pending.request.frame

    # A request that is alone, for which the client writes and reads in one call.

    def begin_alone(self, request: EncodedRequest, now: float, grace: float) -> Alone | None:
        """Begin a request if nothing else is under way, nor any reply outstanding.

        The caller sends it on a drained line, feeds ``framer`` what comes first, and calls
        :meth:`end_alone` or :meth:`resume`, or :meth:`end_unsent` if it could not send it. If it
        does none of these, after Ctrl-C, say, it calls :meth:`settle`.
        """
        last = self._last
        if (
            (last is not None and not last.done)
            or self._queue
            or self._outstanding.replies
            or self._acks.waiting
            or self._alone is not None
            or self.alignment.align
        ):
            return None
        fed = self.framer.fed
        self._echo.sent(request, fed)
        self._sent_last = request.frame
        self._alone = alone = request, now, fed, grace
        return alone

    def end_alone(self, frame: Frame) -> bool:
        """Return whether the only frame that came is the reply; the codec has decoded it as such.

        If it may be a copy of another request, the caller resumes the request with the frame.
        """
        if not self._echo.sent_no_other(frame):
            return False
        self._alone = None
        return True

    @property
    def is_alone(self) -> bool:
        """Whether a request began alone, and has neither ended nor been resumed."""
        return self._alone is not None

    def end_unsent(self) -> None:
        """Note that a request that had begun alone was not sent."""
        self._alone = None

    def resume(
        self, alone: Alone, pending: PendingRequest, received: Sequence[Event], now: float
    ) -> list[SessionEvent]:
        """Go on with a request that began alone as with any other; return what was received."""
        _, sent_at, offset, _ = alone
        pending.begin(sent_at, offset)
        self._last, self._alone = pending, None
        self._chunk_at = offset
        return self._sort(received, now)

    def settle(self, alone: Alone | None = None) -> None:
        """Expect the reply to a request that began alone, and whose caller is gone."""
        if self._alone is not None and (alone is None or alone is self._alone):
            (request, sent_at, _, grace), self._alone = self._alone, None
            self._outstanding.expect(request, sent_at + grace)

    @property
    def waiting_plainly(self) -> EncodedRequest | None:
        """The request that waits, if it is plain."""
        last = self._last
        return None if last is None or last.done or not last.request.plain else last.request

    def take_reply(self, frame: Frame, fields: dict[str, Any], now: float) -> bool:
        """End the plain request that waits, with the only frame that came; return whether it did.

        The codec has decoded the frame as the reply. If it may be a copy of another request, the
        caller sorts it.
        """
        waiting = self._last
        if waiting is None or not self._echo.sent_no_other(frame):
            return False
        self._reply(waiting, fields, now)
        return True

    def sort(self, received: Sequence[Event], fed: int, now: float) -> list[SessionEvent]:
        """Return what events are; the framer had been fed ``fed`` bytes before theirs."""
        self._chunk_at = fed
        return self._sort(received, now)

    @property
    def busy(self) -> bool:
        """Whether a request waits for its turn or its reply, or for its acknowledgement."""
        return bool(self._queue or self._acks.waiting) or self._waiting() is not None

    def _begin(self, pending: PendingRequest, now: float) -> None:
        request, fed = pending.request, self.framer.fed
        self._echo.sent(request, fed)
        pending.begin(now, fed)
        self._last, self._sent_last = pending, request.frame

    # Requests that are queued or wait.

    def _waiting(self) -> PendingRequest | None:
        last = self._last
        return None if last is None or last.done else last

    def _queued(self) -> list[PendingRequest]:
        return [p for p in self._queue if not p.done and p is not self._last]

    def _drop_done(self) -> None:
        self._queue = [pending for pending in self._queue if not pending.done]
        if self._acks.waiting:
            self._acks.drop_done()

    def _free_at(self, pending: PendingRequest, now: float) -> float:
        """Return from when on no late reply can be mistaken for the request's."""
        if not self._outstanding.replies:
            return now
        held_until = self._outstanding.held_until(pending.request)
        return now if held_until is None else held_until

    def _repeat_at(self, waiting: PendingRequest) -> float | None:
        """Return when the request is to be sent again; not while its copy may be its reply."""
        if waiting.candidate is not None and not self._echo.proven:
            return None
        return waiting.repeat_at

    def _next_attempt(self, waiting: PendingRequest, now: float) -> bytes:
        repeat_at = self._repeat_at(waiting)
        if repeat_at is None or repeat_at > now:
            return b""
        self._echo.sent_again()
        waiting.repeat(now)
        return waiting.request.frame

    def _refuse_to_send(self, pending: PendingRequest, now: float) -> None:
        """End a request: the late reply that holds it may be among the bytes not read yet."""
        request, waited = pending.request, now - pending.queued_at
        call = as_call(request, self._codec)
        pending.fail(ReplyTimeout(request.command.name, waited, (NOT_SENT,), 0, call))
        self._drop_done()

    # What ends a request.

    def _reply(self, waiting: PendingRequest, fields: dict[str, Any], now: float) -> None:
        if waiting.request.replier == ANYBODY:
            # Other devices may reply too.
            self._outstanding.expect_late(waiting, 0)
        elif len(waiting.attempt_times) > 1:
            self._outstanding.expect_late(waiting, 1)
        waiting.reply(fields, now)

    def _end_wait(self, waiting: PendingRequest, now: float) -> list[SessionEvent]:
        """End the wait by silence after a text, by a copy that counts as reply, or by timeout."""
        request = waiting.request
        if waiting.text is not None and waiting.text.is_over(now):
            # What waits in the framer came after the text, and does not belong to it.
            try:
                fields = waiting.text.decode()
            except ProtocolError as error:
                waiting.fail(error)
                return [ReplyRejected(request.command, error)]
            waiting.reply(fields, now)
            return [ReplyMatched(request.command, fields, None)]
        # The framer gives up what waits in it, so that a frame hidden after it still counts.
        events = self._sort(self.framer.flush(), now)
        if waiting.done or now < waiting.ends_at:
            return events
        candidate = waiting.candidate
        if candidate is not None and not self._echo.proven:
            self._reply(waiting, candidate.fields, now)
            return [*events, ReplyMatched(request.command, candidate.fields, candidate)]
        attempts, requested_at = len(waiting.attempt_times), waiting.requested_at
        self._outstanding.expect_late(waiting, 0)
        waiting.expire(self._codec, now - requested_at, attempts)
        return [*events, RequestExpired(request.command, requested_at, attempts)]

    # What received bytes are.

    def _sort(self, received: Sequence[Event], now: float) -> list[SessionEvent]:
        return [
            self._take_noise(event, now) if isinstance(event, Noise) else self._match(event, now)
            for event in received
        ]

    def _take_noise(self, noise: Noise, now: float) -> Noise:
        self._others.take_noise(noise, self._waiting(), now)
        return noise

    def _match(self, frame: Frame, now: float) -> SessionEvent:
        """Find out what a frame is; end the request that it replies to."""
        is_copy = self._echo.take_copy(frame)
        waiting = self._last
        if waiting is None or waiting.done or not waiting.accepts(frame):
            return self._match_other(frame, self._waiting(), now, is_copy)
        request = waiting.request
        if request.replier is not None:
            address = self._format.address(frame.data)
            if not can_come_from(address, request):
                return self._match_other(frame, waiting, now, is_copy)
        try:
            message = frame.decode("reply", of=request.command.name)
        except ProtocolError as error:
            if replies_elsewhere(frame, request.command, self._codec.table):
                return self._match_other(frame, waiting, now, is_copy)
            return self._others.reject(frame, error, waiting, is_copy)
        if is_copy:
            return self._others.weigh_copy(frame, message, waiting)
        if request.arguments and not repeats_arguments(message, request):
            return self._match_other(frame, waiting, now, is_copy)
        fields = message.fields
        self._reply(waiting, fields, now)
        return ReplyMatched(request.command, fields, message, frame)

    def _match_other(
        self, frame: Frame, waiting: PendingRequest | None, now: float, is_copy: bool
    ) -> SessionEvent:
        began_at = now if frame.offset >= self._chunk_at else -inf
        return self._others.match(frame, waiting, now, began_at, is_copy)
