"""The exchange over one transport, step by step: read, let time pass, write the next request.

Writing is separate from reading. A thread that sends a one-way request writes it at once. Of the
threads that wait for replies, one leads: it reads for all, feeds the exchange, sends the next
request and wakes the others. So a single caller reads its own reply without a switch of threads,
and a one-way request never waits for another thread's reply.

Ctrl-C may come anywhere. Locks are taken by ``with`` and held briefly, so none stays locked.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from math import inf

from cobotwire.client.leading import Leading
from cobotwire.client.traffic import TrafficListeners
from cobotwire.client.writing import Writer
from cobotwire.protocol.errors import LinkError
from cobotwire.session import Exchange, Pending, PendingRequest
from cobotwire.session.outstanding import PersistedState
from cobotwire.transport.interface import Transport

# The longest that the reading thread waits before it checks whether others have queued a request.
SLICE_SECONDS = 0.02
# How long the leader pauses for a thread that writes.
TURN_SECONDS = 0.0005
# The least time that a write has, if a deadline limits it.
SHORTEST_WRITE = 0.02
# A write that takes longer than this was held up by a full line.
SLOW_WRITE_SECONDS = 0.005


class Steps:
    """The steps of an exchange; every method may be called from any thread.

    Attributes:
        state: held around every step of the exchange.
        reading: held from reading bytes until they are sorted and reported, so that they stay in
            order. Reentrant, since a traffic listener may call the arm. Taken before the lock of
            the writer, which is taken before ``state``.
        leading: which thread reads for all.
        writer: writes requests.
    """

    def __init__(
        self,
        transport: Transport,
        exchange: Exchange,
        listeners: TrafficListeners,
        now: Callable[[], float],
        deadline: float = inf,
    ) -> None:
        """Store what the steps use, and the number of seconds that a call may take."""
        self._transport = transport
        self.exchange = exchange
        self.listeners = listeners
        self.now = now
        self.writer = Writer(transport, exchange.alignment, deadline)
        self.state = threading.Lock()
        self.reading = threading.RLock()
        self.leading = Leading(self.state)

    def leave_to_parent(self) -> None:
        """Free what other threads of the parent held when it forked."""
        self.writer.leave_to_parent()
        self.state, self.reading = threading.Lock(), threading.RLock()
        self.leading = Leading(self.state)

    def persist(self, now: float) -> PersistedState:
        """Return what the next session on this port must respect."""
        with self.state:
            return self.exchange.persist(now)

    def start(self, pending: PendingRequest) -> None:
        """Queue a request. If nothing is under way, take received bytes and send it at once."""
        with self.state:
            self.exchange.enqueue(pending)
        if self.leading.take_lead():
            self.turn(0.0, pending.ends_by)

    def wait(self, pending: Pending) -> None:
        """Lead or follow until a request is done."""
        while not pending.done:
            if self.leading.take_lead():
                self.turn(SLICE_SECONDS, pending.ends_by)
            elif (left := pending.ends_by - self.now()) > 0:
                self.leading.follow(pending, left)
            else:
                # Even if the leader hangs, no other thread waits longer than it may.
                with self.state:
                    events = self.exchange.end_overdue(now := self.now())
                self.listeners.received(events, now)

    def leave(self, pending: Pending) -> None:
        """Leave everything ready for the next call, also if Ctrl-C or a lost port ends this."""
        if not pending.done:
            with self.state:
                self.exchange.give_up(pending)
        self.leading.resign()

    def turn(self, longest: float, ends_by: float = inf) -> None:
        """Read once, let time pass, and send the request that is next; this thread leads.

        The caller waits until ``ends_by`` at the latest.
        """
        with self.reading:
            self.leading.count_turn()
            if longest > 0:
                with self.state:
                    idle = self.exchange.idle_seconds(self.now())
                longest = longest if idle is None else min(idle, longest)
            self._advance(self._read(longest), ends_by)

    def drain(self, until: float) -> None:
        """Read received bytes, so that no buffer overflows while only one-way requests are sent."""
        with self.reading:
            while data := self._transport.read(0):
                now = self.now()
                with self.state:
                    events = self.exchange.receive(data, now)
                self.listeners.received(events, now)
                if now >= until:
                    return

    def _read(self, longest: float) -> bytes:
        try:
            return self._transport.read(longest)
        except LinkError as error:
            self._lose(error)
            raise

    def _advance(self, data: bytes, ends_by: float) -> None:
        """Take what was read, let time pass, and send the request that is next."""
        exchange, now = self.exchange, self.now()
        with self.state:
            events = exchange.advance(data, now)
            has_next = exchange.has_next(now)
        if has_next:
            free = self.writer.is_free()
            if not free:
                # The line is full, or another thread writes. Deadlines go on meanwhile.
                time.sleep(TURN_SECONDS)
                free = self.writer.is_free()
            exchange.note_full(not free)
            if free:
                self._send_request(not data, ends_by)
        if events:
            self.leading.wake_followers()
            self.listeners.received(events, now)

    def _send_request(self, drained: bool, ends_by: float) -> None:
        with self.writer.lock:
            with self.state:
                now = self.now()
                data = self.exchange.outgoing(now, drained)
                pending = self.exchange.sent_last
            if not data or pending is None:
                return
            align = self._write_request(pending, data, now, ends_by)
        if align is not None:
            self.listeners.sent(align, data)

    def _write_request(
        self, pending: PendingRequest, data: bytes, now: float, ends_by: float
    ) -> bytes | None:
        """Write a request returned by the exchange at ``now``; the caller holds the writer's lock.

        The write ends before the deadline of ``pending``, and before ``ends_by``, the deadline of
        this thread's own call.

        Returns:
            As :meth:`Writer.write`; None if the request was not written.
        """
        writer, longest = self.writer, max(SHORTEST_WRITE, min(ends_by, pending.ends_by) - now)
        try:
            return writer.write_if_free(data) if pending.repeated else writer.write(data, longest)
        except LinkError as error:
            with self.state:
                self.exchange.fail_waiting(error)
            return None
        finally:
            if self.now() - now > SLOW_WRITE_SECONDS:
                with self.state:
                    self.exchange.written(pending, self.now())

    def _lose(self, error: LinkError) -> None:
        """End every request: the transport is gone."""
        now = self.now()
        with self.state:
            events = self.exchange.fail(error, now)
        self.leading.wake_followers()
        self.listeners.received(events, now)
        self.listeners.lost(error)
