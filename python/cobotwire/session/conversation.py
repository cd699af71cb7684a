"""Everything that is decided while callers share one line; no clock, thread or port in here.

Drivers are thin loops over this, and the only difference between them is how they wait:

* a request goes in by :meth:`Conversation.ask` or :meth:`Conversation.order`;
* bytes that came go in by :meth:`Conversation.receive`, time by :meth:`Conversation.wake`;
* bytes to send come out of ``order`` at once, and out of :meth:`Conversation.outgoing` for
  questions; :meth:`Conversation.wait` says how long nothing needs to be done.

**Orders** (settings, motion: whatever nothing answers) go out at once and once only, also while a
question waits. **Questions** take turns, one at a time, in the order in which they were asked; one
that is held for an owed reply is overtaken by those that are not. A question's deadline runs from
the moment in which it is first sent: what it measures is the arm's silence, not the queue, and each
question in front ends by its own deadline.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any

from cobotwire.codec.interface import Codec
from cobotwire.errors import LinkError, ReplyTimeout
from cobotwire.session.events import (
    Acknowledged,
    Answered,
    Expired,
    Refused,
    SessionEvent,
)
from cobotwire.session.host import HostSession
from cobotwire.session.policy import RetryPolicy
from cobotwire.session.request import Request
from cobotwire.session.ticket import Order, Question, Ticket

# How long what came before a question is read, if there is no end of that.
CLEAR_SECONDS = 0.05
NOT_SENT = (
    "more than can be read; an answer to an earlier question may be among it, "
    "so this one was not sent"
)


class Conversation:
    """Questions in their turns and orders at once, over one :class:`HostSession`."""

    def __init__(self, codec: Codec) -> None:
        self._codec = codec
        self._host = HostSession(codec)
        self._queue: deque[Question] = deque()
        self._asked: Question | None = None
        self._orders: list[Order] = []

    def prepare(
        self, name: str, values: Sequence[Any], text_values: Mapping[str, str] | None = None
    ) -> Request:
        """Check and spell a request; nothing changes.

        Raises:
            UsageError: there is no such command, or the arguments are not allowed.
        """
        return self._host.prepare(name, values, text_values)

    def ask(
        self, request: Request, now: float, policy: RetryPolicy, wait: float | None = None
    ) -> Question:
        """Queue a question; ``wait`` is the seconds that the arm has, None: the edition's."""
        question = Question(request, wait, policy, now)
        self._queue.append(question)
        return question

    def order(
        self, request: Request, now: float, ack_within: float | None = None
    ) -> tuple[bytes, Order | None]:
        """The bytes of an order, to be sent now; and a ticket if its acknowledgement is wanted."""
        data, due = self._host.order(request, now, ack_within or 0.0)
        if ack_within is None or due is None:
            return data, None
        order = Order(request, due, now, now + ack_within)
        self._orders.append(order)
        return data, order

    def give_up(self, ticket: Ticket) -> None:
        """Its caller waits no longer. A reply that comes all the same is late."""
        if ticket.done:
            return
        if ticket is self._asked:
            self._host.abandon()
            self._asked = None
        if isinstance(ticket, Question) and ticket in self._queue:
            self._queue.remove(ticket)
        if isinstance(ticket, Order) and ticket in self._orders:
            self._orders.remove(ticket)
        ticket.done = True

    def fail(self, error: LinkError) -> None:
        """The link is gone: so is whatever waits."""
        tickets = [*self._queue, *self._orders]
        if self._asked is not None:
            self._host.abandon()
            tickets.append(self._asked)
        self._queue.clear()
        self._orders.clear()
        self._asked = None
        for ticket in tickets:
            ticket.fail(error)

    def fail_asked(self, error: LinkError) -> None:
        """The question that :meth:`outgoing` gave could not be written."""
        asked = self._asked
        if asked is not None:
            self._host.abandon()
            self._asked = None
            asked.fail(error)

    def receive(self, data: bytes, now: float) -> list[SessionEvent]:
        """Take what the line brought."""
        events = self._host.receive(data, now)
        for event in events:
            self._tell(event, now)
        return events

    def wake(self, now: float) -> list[SessionEvent]:
        """Let time pass. What has come must be received before, or it counts as late."""
        events = [] if self._asked is None else self._host.wake(now)
        for event in events:
            self._tell(event, now)
        late = [order for order in self._orders if order.until <= now] if self._orders else ()
        for order in late:
            self._orders.remove(order)
            if order.due.copied and not self._host.echoes:
                order.succeed({})
            else:
                order.fail(order.silence(self._codec, now - order.sent_at, 1))
        return events

    def wait(self, now: float) -> float | None:
        """For how many seconds nothing is to be done unless bytes come; None: without end."""
        if self._asked is not None and not self._host.waiting:
            self._heal(self._asked)
        soonest = None
        if self._asked is not None:
            soonest = self._host.next_at
        elif self._queue:
            soonest = min([self._free_at(question, now) for question in self._queue])
        for order in self._orders:
            soonest = order.until if soonest is None else min(soonest, order.until)
        return None if soonest is None else max(0.0, soonest - now)

    def due(self, now: float) -> bool:
        """Whether :meth:`outgoing` may have something to send now."""
        if self._asked is None:
            return bool(self._queue)
        again_at = self._host.again_at
        return again_at is not None and again_at <= now

    def outgoing(self, now: float, dry: bool) -> bytes:
        """The bytes of a question that is to be sent now, for the first time or again.

        ``dry``: whether everything that has come by now was received. A question goes out on a dry
        line, so that what came before it cannot pass for its answer.
        """
        if self._asked is not None:
            again_at = self._host.again_at
            return self._host.again(now) if again_at is not None and again_at <= now else b""
        question = self._next(now)
        if question is None:
            return b""
        if not dry:
            # A line that brings more than can be read is never dry.
            if question.ready_since is None:
                question.ready_since = now
            if now < question.ready_since + CLEAR_SECONDS:
                return b""
            if self._host.hold_until(question.request) is not None:
                # Where an old answer is owed, it may lie in what has not been read.
                self._queue.remove(question)
                waited = now - question.queued_at
                question.fail(ReplyTimeout(question.request.command.name, waited, (NOT_SENT,), 0))
                return b""
        # In this order: an interrupt between two of these leaves nobody waiting for ever.
        self._asked = question
        self._queue.remove(question)
        question.asked_at = now
        return self._host.send(question.request, now, question.wait, question.policy)

    def _heal(self, asked: Question) -> None:
        """Ctrl-C came while the state was changed in a driver's thread: another one's question."""
        self._asked = None
        if asked.asked_at is not None:
            asked.fail(asked.silence(self._codec, 0.0, 1))
        elif asked not in self._queue:
            self._queue.appendleft(asked)

    def _free_at(self, question: Question, now: float) -> float:
        held = self._host.hold_until(question.request)
        return now if held is None else held

    def _next(self, now: float) -> Question | None:
        """The first question that is not held."""
        for question in self._queue:
            if self._free_at(question, now) <= now:
                return question
        return None

    def _tell(self, event: SessionEvent, now: float) -> None:
        """Hand an event to the tickets that it concerns."""
        asked = self._asked
        if isinstance(event, (Answered, Refused, Expired)):
            assert asked is not None, "only a question that was asked ends"
            self._asked = None
            if isinstance(event, Answered):
                asked.answered_at = now
                asked.succeed(event.fields)
            elif isinstance(event, Refused):
                asked.fail(event.error)
            else:
                asked.fail(asked.silence(self._codec, now - event.asked_at, event.tries))
        elif isinstance(event, Acknowledged):
            for order in [order for order in self._orders if order.due.done]:
                self._orders.remove(order)
                order.succeed({})
        else:
            for ticket in (asked, *self._orders):
                if ticket is not None:
                    ticket.heard.add(event)
