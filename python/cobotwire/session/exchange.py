"""The exchange of requests and replies over one transport, shared by many callers.

This is the session's state machine: everything that decides a state stands in this file. It has no
clock, thread or port: bytes and times go in, bytes and events come out, and clients differ only in
how they wait. ``docs/contribute/exchange.md`` shows its states and what it promises.

A request that has a reply passes through three states::

    queued ──outgoing()──▶ waiting ──reply, error or deadline──▶ done
       │                      │ ▲
       │                      └─┘ outgoing(), for another attempt
       └───────────────── give_up(), fail() ───────────────────▶ done

Only one request waits at a time, since the protocol has no sequence numbers. The others queue in
the order of submission; one that is held for an outstanding reply is overtaken. The time to reply
runs from the first sending, so that it measures the arm's silence and not the queue. A caller's
deadline runs from the call: a request that was not sent by then is never sent. One-way requests
(settings, motion: whatever has no reply) are sent at once, and only once, also while another
request waits.

Ctrl-C can interrupt any step in a client's thread. So each step commits with a single assignment:
of ``done``, which ends a request, or of ``_last``, which makes it the one that waits. Other entries
that an interrupt leaves in the lists are skipped.
"""

from __future__ import annotations

from math import inf
from typing import Any

from cobotwire.codec.interface import Codec, Event, Frame, Noise
from cobotwire.protocol.addresses import ANYBODY, NOBODY
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import LinkError, ProtocolError, ReplyTimeout, WaitedFor
from cobotwire.protocol.shared import once_per_table
from cobotwire.protocol.table import Table
from cobotwire.session.acks import Acks, PendingAck
from cobotwire.session.alignment import Alignment
from cobotwire.session.echo import EchoDetector
from cobotwire.session.events import (
    AckReceived,
    EchoReceived,
    FrameEvent,
    LateReply,
    ReplyMatched,
    ReplyRejected,
    RequestExpired,
    SessionEvent,
    UnexpectedFrame,
)
from cobotwire.session.matching import as_event, as_reply, repeats_arguments
from cobotwire.session.outstanding import (
    LateFrame,
    OutstandingReplies,
    PersistedState,
    late_replies,
)
from cobotwire.session.pending import Pending, PendingRequest
from cobotwire.session.request import EncodedRequest, as_call, request_of

# For how long received bytes are read before a request is sent, if they do not end.
DRAIN_SECONDS = 0.05
# Why a request is not sent after an error has ended the client's block.
ENDING = "an error ended the program's with block, so only stop is sent any more"


@once_per_table
def _replying_ids(table: Table) -> frozenset[int]:
    return frozenset(command.id for command in table.commands if command.requires_reply)


class Exchange:
    """Requests that take turns, one-way requests, and the frames that come back.

    Attributes:
        alignment: what the peer may hold of a request that was cut.
    """

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._replying_ids = _replying_ids(codec.table)
        self._framer = codec.framer("reply")
        self.alignment = Alignment(codec)
        self._outstanding = OutstandingReplies()
        self._acks = Acks(codec)
        self._echo = EchoDetector()
        # Requests that wait for their turn, oldest first. An interrupt may leave requests in it
        # that are done or sent.
        self._queue: list[PendingRequest] = []
        # The request that was sent last; it waits for its reply unless it is done.
        self._last: PendingRequest | None = None
        # Whether the line took no bytes when the next request was to be sent.
        self._line_is_full = False
        # The error of every request that is not sent any more; None: all requests are sent.
        self._ending: LinkError | None = None

    # What callers want.

    def enqueue(self, pending: PendingRequest) -> None:
        """Queue a request. Its caller already holds it, so that an interrupt cannot lose it.

        It fails at once if the exchange sends only ``stop`` and ``halt``.
        """
        if self._ending is not None:
            pending.fail(self._ending)
        else:
            self._queue.append(pending)

    def send_only_stops(self, url: str) -> None:
        """Send only commands with the role ``stop`` or ``halt`` from now on.

        Other requests fail with a LinkError for ``url``, also those that wait for their turn. The
        request that waits for its reply goes on.
        """
        self._ending = LinkError(url, ENDING)
        for pending in self._queued():
            pending.fail(self._ending)

    def send_one_way(
        self,
        request: EncodedRequest,
        now: float,
        ack_within: float | None = None,
        ends_by: float = inf,
    ) -> tuple[bytes, PendingAck | None]:
        """Return the bytes of a one-way request, to be written now.

        The second result is None unless the edition acknowledges the request and its caller waits
        for that: at most ``ack_within`` seconds, and not after ``ends_by``.

        Raises:
            LinkError: only ``stop`` and ``halt`` are sent any more.
        """
        if self._ending is not None and not request.command.is_stop:
            raise LinkError(self._ending.url, self._ending.detail)
        offset = self._framer.fed
        self._echo.sent_one_way(request.frame, offset)
        self.alignment.sent(request.frame)
        if not request.command.ack or request.replier == NOBODY:
            return request.frame + request.text, None
        ack, pending = self._acks.expect(request, now, offset, ack_within, ends_by)
        if request.command.id in self._replying_ids:
            self._outstanding.drop_expired(now)
            self._outstanding.expect(request, ack.until)
        return request.frame + request.text, pending

    def unsent(self, request: EncodedRequest, waited: float) -> ReplyTimeout:
        """Return the error of a one-way request that its caller's deadline keeps from being sent.

        ``waited`` is for how many seconds the line took no bytes.
        """
        call = as_call(request, self._codec)
        return ReplyTimeout(request.command.name, waited, (), 0, call, "line")

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
            The events of the bytes that waited for the rest of a frame. Bytes that are received
            after the transport is opened again do not complete them.
        """
        events = self._sort(self._framer.flush(), now, self._framer.fed)
        self.alignment.lose()
        self.fail_waiting(error)
        for pending in self._queue:
            if not pending.done:
                pending.fail(error)
        self._acks.fail(error)
        self._drop_done()
        return events

    def fail_waiting(self, error: LinkError) -> None:
        """End the request that waits: its bytes were not written, or not all of them."""
        waiting = self._waiting()
        if waiting is not None:
            self._outstanding.expect_late(waiting, 0)
            waiting.fail(error)

    # What one session leaves to the next one on its port.

    def persist(self, now: float) -> PersistedState:
        """Return what the next session on this port must respect."""
        waiting = self._waiting()
        replies = [reply for reply in self._outstanding.replies if reply.until > now]
        if waiting is not None:
            replies += late_replies(waiting, 0)
        late = tuple(LateFrame(reply.request.frame, reply.until) for reply in replies)
        return PersistedState(late, self.alignment.held)

    def restore(self, state: PersistedState) -> None:
        """Respect what an earlier session left on this port."""
        for late in state.late:
            request = request_of(late.request, self._codec)
            if request is not None:
                self._outstanding.expect(request, late.until)
        if state.parts:
            self.alignment.hold(state.parts)

    # What the client's loop does.

    def advance(self, data: bytes, now: float) -> list[SessionEvent]:
        """Take received bytes, then let time pass: :meth:`receive` and :meth:`wake`.

        Received bytes are taken before time passes, or their frames would count as late.
        """
        return self.receive(data, now) + self.wake(now) if data else self.wake(now)

    def receive(self, data: bytes, now: float) -> list[SessionEvent]:
        """Take received bytes; return what they are."""
        chunk_at = self._framer.fed
        return self._sort(self._framer.feed(data), now, chunk_at)

    def wake(self, now: float) -> list[SessionEvent]:
        """Let time pass; return what this ends. Pass received bytes to :meth:`receive` first."""
        waiting = self._waiting()
        if waiting is not None and waiting.ends_at <= now:
            return self._end_wait(waiting, now) + self.end_overdue(now)
        return self.end_overdue(now)

    def end_overdue(self, now: float) -> list[SessionEvent]:
        """End requests whose caller's deadline has passed; return the events of a sent one."""
        if self._acks.waiting:
            self._acks.wake(now, self._echo.proven)
        for pending in self._queue:
            if pending.ends_by <= now:
                self._end_overdue_queued(now)
                break
        waiting = self._waiting()
        if waiting is None or waiting.ends_by > now:
            return []
        # A copy of the request does not count as its reply: the reply still had time to come.
        return self._expire(waiting, now, now - waiting.queued_at, "reply")

    def note_full(self, full: bool) -> None:
        """Note whether the line took no bytes when a request was to be sent."""
        self._line_is_full = full

    def has_next(self, now: float) -> bool:
        """Return whether :meth:`outgoing` may have something to send."""
        waiting = self._waiting()
        return bool(self._queue) if waiting is None else self._repeat_at(waiting) <= now

    def outgoing(self, now: float, drained: bool) -> bytes:
        """Return the bytes of the request to be sent now, for the first time or again.

        ``drained``: whether everything that has come by now was received. A request is sent on a
        drained line, so that earlier bytes cannot be mistaken for its reply.
        """
        waiting = self._waiting()
        if waiting is not None:
            return self._next_attempt(waiting, now)
        for pending, free_at in self._free_times(now):
            if free_at <= now < pending.ends_by:
                break
        else:
            return b""
        if not drained:
            # A line that brings more than can be read is never drained.
            pending.note_undrained(now)
            if now - pending.undrained_since < DRAIN_SECONDS:
                return b""
            if self._outstanding.held_until(pending.request) is not None:
                self._refuse_to_send(pending, now)
                return b""
        if self._outstanding.replies:
            self._outstanding.drop_expired(now)
        self._begin(pending, now)
        return pending.request.frame

    @property
    def sent_last(self) -> PendingRequest | None:
        """The request that :meth:`outgoing` returned last; it may be done by now."""
        return self._last

    def written(self, pending: PendingRequest, now: float) -> None:
        """Note that a request was written whole only now: the time for its reply runs from now."""
        if pending.done:
            self._outstanding.expect(pending.request, now + pending.policy.grace)
        else:
            pending.written(now)

    def idle_seconds(self, now: float) -> float | None:
        """Return for how long nothing is to be done unless bytes come; None: without limit."""
        soonest = self._acks.next_end if self._acks.waiting else inf
        waiting = self._waiting()
        if waiting is not None:
            soonest = min(soonest, waiting.ends_at, waiting.ends_by, self._repeat_at(waiting))
        if self._queue:
            soonest = min([soonest, *(pending.ends_by for pending in self._queued())])
            if waiting is None:
                soonest = min([soonest, *(free_at for _, free_at in self._free_times(now))])
        return None if soonest == inf else max(0.0, soonest - now)

    @property
    def busy(self) -> bool:
        """Whether a request waits for its turn or its reply, or for its acknowledgement."""
        return bool(self._queue or self._acks.waiting or self._waiting() is not None)

    # Whose turn it is.

    def _waiting(self) -> PendingRequest | None:
        """Return the request that waits for its reply."""
        last = self._last
        return None if last is None or last.done else last

    def _queued(self) -> list[PendingRequest]:
        return [p for p in self._queue if not p.done and p is not self._last]

    def _drop_done(self) -> None:
        self._queue = [pending for pending in self._queue if not pending.done]
        if self._acks.waiting:
            self._acks.drop_done()

    def _free_times(self, now: float) -> list[tuple[PendingRequest, float]]:
        """Return each queued request with the time after which no late reply looks like its own."""
        queued = self._queued()
        if not self._outstanding.replies:
            return [(pending, now) for pending in queued]
        # Many callers may have queued the same frame, which is checked once.
        alike = {pending.request.frame: pending.request for pending in queued}
        held = {frame: self._outstanding.held_until(request) for frame, request in alike.items()}
        known = {frame: now if until is None else until for frame, until in held.items()}
        return [(pending, known[pending.request.frame]) for pending in queued]

    def _begin(self, pending: PendingRequest, now: float) -> None:
        """Make a queued request the one that waits."""
        frame, offset = pending.request.frame, self._framer.fed
        self._echo.sent(frame, offset)
        self.alignment.sent(frame)
        pending.begin(now, offset)
        self._last = pending
        self._queue.remove(pending)

    def _repeat_at(self, waiting: PendingRequest) -> float:
        """Return when the request is to be sent again; not while its copy may be its reply."""
        if waiting.candidate is not None and not self._echo.proven:
            return inf
        return waiting.repeat_at

    def _next_attempt(self, waiting: PendingRequest, now: float) -> bytes:
        if not self._repeat_at(waiting) <= now < waiting.ends_by:
            return b""
        self._echo.sent_again()
        waiting.repeat(now)
        return waiting.request.frame

    def _refuse_to_send(self, pending: PendingRequest, now: float) -> None:
        """End a request: the late reply that holds it may be among the bytes not read yet."""
        request, waited = pending.request, now - pending.queued_at
        call = as_call(request, self._codec)
        pending.fail(ReplyTimeout(request.command.name, waited, (error_text("too-much"),), 0, call))
        self._drop_done()

    def _end_overdue_queued(self, now: float) -> None:
        for pending, free_at in self._free_times(now):
            if pending.ends_by <= now:
                full: WaitedFor = "line" if self._line_is_full else "turn"
                waited_for = "hold" if free_at > now else full
                pending.expire(self._codec, now - pending.queued_at, 0, waited_for)
        self._drop_done()

    # What received bytes are, and how the request that waits ends by them or by silence.

    def _sort(self, received: list[Event], now: float, chunk_at: int) -> list[SessionEvent]:
        """Return what the framer's events are; the bytes received last began at ``chunk_at``."""
        return [
            self._take_noise(event, now)
            if isinstance(event, Noise)
            else self._match(event, now, now if event.offset >= chunk_at else -inf)
            for event in received
        ]

    def _take_noise(self, noise: Noise, now: float) -> Noise:
        """Take noise, which may be the text that a request waits for."""
        self._echo.add_noise(noise)
        waiting = self._waiting()
        if waiting is not None and waiting.text is not None:
            # A text that began before the request was sent does not belong to it.
            waiting.text.add(noise.data[max(0, waiting.offset - noise.offset) :], now)
        self._note(noise)
        return noise

    def _match(self, frame: Frame, now: float, began_at: float) -> SessionEvent:
        """Find out what a frame is; its first byte came at ``began_at`` or earlier."""
        is_copy = self._echo.take_copy(frame)
        waiting = self._waiting()
        if waiting is None or not waiting.accepts(frame):
            return self._note(self._match_other(frame, now, began_at, is_copy))
        reply = as_reply(frame, waiting.request, self._codec.table)
        if isinstance(reply, ProtocolError):
            return self._reject(frame, reply, waiting, is_copy)
        if reply is None or not (is_copy or repeats_arguments(reply, waiting.request)):
            return self._note(self._match_other(frame, now, began_at, is_copy))
        if not is_copy:
            fields = reply.fields
            self._end(waiting, fields, now)
            return ReplyMatched(waiting.request.command, fields, reply, frame)
        # A copy that can be the reply is kept; one that cannot proves that the line echoes.
        if repeats_arguments(reply, waiting.request):
            waiting.keep_candidate(reply)
        else:
            self._echo.prove()
        return self._note(EchoReceived(frame))

    def _match_other(self, frame: Frame, now: float, began_at: float, is_copy: bool) -> FrameEvent:
        """Find out what a frame is that does not reply to the request that waits."""
        late = self._outstanding.find(frame, now)
        if late is not None:
            if late.request.command.requires_reply:
                # The reply stays outstanding: this may be a copy, with the reply still to come.
                return LateReply(late.request.command, frame)
            self._outstanding.settle(late)
        if is_copy:
            self._acks.note_copy(frame)
            return EchoReceived(frame)
        ack = self._acks.match(frame, now, began_at)
        if ack is not None:
            return AckReceived(ack.request.command, ack.message, frame)
        return as_event(frame, self._codec.table) or UnexpectedFrame(frame)

    def _reject(
        self, frame: Frame, error: ProtocolError, waiting: PendingRequest, is_copy: bool
    ) -> SessionEvent:
        """End a request with a reply of illegal values, unless the frame is something else."""
        if is_copy:
            self._echo.prove()
            return self._note(EchoReceived(frame))
        if self._outstanding.has_command(frame):
            return self._note(UnexpectedFrame(frame))
        if waiting.repeated:
            self._outstanding.expect_late(waiting, 1)
        waiting.fail(error)
        return ReplyRejected(waiting.request.command, error, frame)

    def _end(self, waiting: PendingRequest, fields: dict[str, Any], now: float) -> None:
        """End the request that waits with its reply."""
        if waiting.request.replier == ANYBODY:
            # Other devices may reply too.
            self._outstanding.expect_late(waiting, 0)
        elif waiting.repeated:
            self._outstanding.expect_late(waiting, 1)
        waiting.reply(fields, now)

    def _end_wait(self, waiting: PendingRequest, now: float) -> list[SessionEvent]:
        """End the wait by silence after a text, by a copy that counts as reply, or by timeout."""
        request = waiting.request
        if waiting.text is not None and waiting.text.is_over(now):
            # Bytes that wait in the framer came after the text, and do not belong to it.
            try:
                fields = waiting.text.decode()
            except ProtocolError as error:
                waiting.fail(error)
                return [ReplyRejected(request.command, error)]
            waiting.reply(fields, now)
            return [ReplyMatched(request.command, fields, None)]
        # Flush the framer, so that a frame after the incomplete bytes is found.
        events = self._sort(self._framer.flush(), now, self._framer.fed)
        if waiting.done or now < waiting.ends_at:
            return events
        candidate = waiting.candidate
        if candidate is not None and not self._echo.proven:
            self._end(waiting, candidate.fields, now)
            return [*events, ReplyMatched(request.command, candidate.fields, candidate)]
        return events + self._expire(waiting, now, now - waiting.requested_at)

    def _expire(
        self,
        waiting: PendingRequest,
        now: float,
        waited: float,
        waited_for: WaitedFor | None = None,
    ) -> list[SessionEvent]:
        """End the request that waits with a ReplyTimeout; its reply may still come."""
        attempts = len(waiting.attempt_times)
        self._outstanding.expect_late(waiting, 0)
        waiting.expire(self._codec, waited, attempts, waited_for)
        return [RequestExpired(waiting.request.command, waiting.requested_at, attempts)]

    def _note(self, event: FrameEvent | Noise) -> SessionEvent:
        """Add an event to each waiting request, for the text of a timeout."""
        waiting = self._waiting()
        if waiting is not None:
            waiting.note(event)
        if self._acks.waiting:
            self._acks.note(event)
        return event
