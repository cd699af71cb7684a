"""The exchange of requests and replies over one transport, shared by many callers.

This is the session's state machine. It has no clock, thread or port: bytes and times go in, bytes
and events come out, and clients differ only in how they wait.

A request that has a reply passes through three states::

    queued ──outgoing()──▶ waiting ──reply, error or deadline──▶ done
       │                      │ ▲
       │                      └─┘ outgoing(), for another attempt
       └───────────────── give_up(), fail() ───────────────────▶ done

Only one request waits at a time, since the protocol has no sequence numbers: ``turns`` says which
one. ``replies`` matches what is received to it. One-way requests (settings, motion: whatever has no
reply) take no turns. They are sent at once, and only once, also while another request waits.

Ctrl-C can interrupt any step in a client's thread. So each step commits with a single assignment:
``done`` ends a request, ``last`` makes it the one that waits. What an interrupt leaves in the lists
besides is skipped.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import Any

from cobotwire.codec.interface import Codec, Event, Frame
from cobotwire.protocol.addresses import NOBODY
from cobotwire.protocol.errors import LinkError, ReplyTimeout
from cobotwire.protocol.shared import once_per_table
from cobotwire.protocol.table import Table
from cobotwire.session.acks import Acks, PendingAck
from cobotwire.session.alignment import Alignment
from cobotwire.session.alone import Alone
from cobotwire.session.echo import EchoDetector
from cobotwire.session.events import SessionEvent
from cobotwire.session.leftover import LateFrame, Leftover
from cobotwire.session.outstanding import OutstandingReplies, late_replies
from cobotwire.session.pending import Pending, PendingRequest
from cobotwire.session.policy import RetryPolicy
from cobotwire.session.replies import Replies
from cobotwire.session.request import EncodedRequest, as_call, request_of
from cobotwire.session.turns import Turns


@once_per_table
def _replying_ids(table: Table) -> frozenset[int]:
    return frozenset(command.id for command in table.commands if command.requires_reply)


class Exchange:
    """Requests that take turns, one-way requests, and the frames that come back.

    Attributes:
        framer: what received bytes are fed to.
        alignment: what the peer may hold of a request that was cut.
        alone: the request for which the client writes and reads in one native call.
    """

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._replying_ids = _replying_ids(codec.table)
        self.framer = framer = codec.framer("reply")
        self.alignment = alignment = Alignment(codec)
        self._outstanding = outstanding = OutstandingReplies()
        self._acks = acks = Acks(codec)
        self._echo = echo = EchoDetector()
        self._turns = turns = Turns(codec, framer, alignment, outstanding, echo)
        self._replies = replies = Replies(codec, framer, turns, outstanding, acks, echo)
        self.alone = Alone(framer, alignment, turns, replies, outstanding, acks, echo)

    # What callers want.

    def submit(
        self,
        request: EncodedRequest,
        now: float,
        policy: RetryPolicy,
        wait: float | None = None,
        ends_by: float = inf,
    ) -> PendingRequest:
        """Queue a request; the arm has ``wait`` seconds to reply, None: those of the edition.

        Its caller waits until ``ends_by``.
        """
        pending = PendingRequest(request, wait, policy, now, ends_by)
        self.enqueue(pending)
        return pending

    def enqueue(self, pending: PendingRequest) -> None:
        """Queue a request whose caller already holds it, and gives it up in any case."""
        self._turns.queue.append(pending)

    def unsent(self, request: EncodedRequest, waited: float) -> ReplyTimeout:
        """Return the error of a one-way request that its caller's deadline keeps from being sent.

        ``waited`` is for how many seconds the line took no bytes.
        """
        call = as_call(request, self._codec)
        return ReplyTimeout(request.command.name, waited, (), 0, call, "line")

    def send_one_way(
        self,
        request: EncodedRequest,
        now: float,
        ack_within: float | None = None,
        ends_by: float = inf,
    ) -> tuple[bytes, PendingAck | None]:
        """Return the bytes of a one-way request, to be written now.

        The second is there if ``ack_within`` says how many seconds its acknowledgement is waited
        for, and the edition has one. Its caller waits until ``ends_by``.
        """
        self._echo.sent_one_way(request, self.framer.fed)
        self.alignment.last_request = request.frame
        if not request.command.ack or request.replier == NOBODY:
            return request.frame + request.text, None
        ack, pending = self._acks.expect(request, now, self.framer.fed, ack_within, ends_by)
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
        self._turns.drop_done()
        if self._acks.waiting:
            self._acks.drop_done()

    def fail(self, error: LinkError, now: float) -> list[SessionEvent]:
        """End every request: the transport is gone.

        Returns:
            What the bytes are that still waited: what comes after the transport is open again does
            not complete them.
        """
        events = self._replies.sort(self.framer.flush(), now)
        self.alignment.lose()
        self._turns.fail_waiting(error)
        for pending in self._turns.queue:
            if not pending.done:
                pending.fail(error)
        self._turns.drop_done()
        self._acks.fail(error)
        return events

    def fail_waiting(self, error: LinkError) -> None:
        """End the request that waits: the bytes that :meth:`outgoing` gave were not written."""
        self._turns.fail_waiting(error)

    # What one session leaves to the next one on its port.

    def leave(self, now: float) -> Leftover:
        """Return what the next session on this port must respect."""
        waiting = self._turns.waiting()
        replies = [reply for reply in self._outstanding.replies if reply.until > now]
        if waiting is not None:
            replies += late_replies(waiting, 0)
        replies += self.alone.outstanding()
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
            What happened, and whether :meth:`outgoing` may have something to send now.
        """
        events = self.receive(data, now) if data else []
        last = self._turns.last
        if last is None or last.done:
            # So it is after each reply.
            if self._acks.waiting:
                self._acks.wake(now, self._echo.proven)
            if self._turns.queue:
                self._turns.end_overdue(now)
            return events, bool(self._turns.queue)
        events += self.wake(now)
        return events, self._turns.has_next(now)

    def receive(self, data: bytes, now: float) -> list[SessionEvent]:
        """Take received bytes; return what they are."""
        self._replies.chunk_at = self.framer.fed
        events = self.framer.feed(data)
        return self._replies.sort(events, now) if events else []

    def wake(self, now: float) -> list[SessionEvent]:
        """Let time pass; return what ends by it. Receive first what has come by now."""
        waiting = self._turns.waiting()
        events = []
        if waiting is not None and waiting.ends_at <= now:
            events = self._replies.end_wait(waiting, now)
        return events + self.end_overdue(now)

    def end_overdue(self, now: float) -> list[SessionEvent]:
        """End the requests of callers that wait no longer; return what happened to a sent one."""
        if self._acks.waiting:
            self._acks.wake(now, self._echo.proven)
        return self._turns.end_overdue(now)

    def note_full(self, full: bool) -> None:
        """Note whether the line took no bytes when a request was to be sent."""
        self._turns.line_is_full = full

    def idle_seconds(self, now: float) -> float | None:
        """Return for how long nothing is to be done unless bytes come; None: without end."""
        soonest = self._turns.next_at(now)
        if self._acks.waiting:
            soonest = min(soonest, self._acks.next_end)
        return None if soonest == inf else max(0.0, soonest - now)

    @property
    def sent_last(self) -> PendingRequest | None:
        """The request that :meth:`outgoing` gave last; it may be done by now."""
        return self._turns.last

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
        self.alone.settle()
        return self._turns.next(now, drained)

    def begin(self, pending: PendingRequest, now: float) -> bytes:
        """Return the bytes of a request if nothing else is under way; otherwise queue it.

        Everything that has come by now was received. This is :meth:`enqueue` and :meth:`outgoing`
        in one step.
        """
        self.alone.settle()
        return self._turns.begin(pending, now)

    @property
    def busy(self) -> bool:
        """Whether a request waits for its turn or its reply, or for its acknowledgement."""
        turns = self._turns
        last = turns.last
        return bool(turns.queue or self._acks.waiting or not (last is None or last.done))

    # What a client does that reads and decodes in one native call.

    @property
    def waiting_plainly(self) -> EncodedRequest | None:
        """The request that waits, if it is plain."""
        last = self._turns.last
        return None if last is None or last.done or not last.request.plain else last.request

    def take_reply(self, frame: Frame, fields: dict[str, Any], now: float) -> bool:
        """End the plain request that waits, with the only frame that came; return whether it did.

        The codec has decoded the frame as the reply. If it may be a copy of another request, the
        caller sorts it.
        """
        waiting = self._turns.last
        if waiting is None or not self._echo.sent_no_other(frame):
            return False
        self._replies.end(waiting, fields, now)
        return True

    def sort(self, received: Sequence[Event], fed: int, now: float) -> list[SessionEvent]:
        """Return what events are; the framer had been fed ``fed`` bytes before theirs."""
        self._replies.chunk_at = fed
        return self._replies.sort(received, now)
