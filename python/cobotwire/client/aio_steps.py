"""The exchange on an event loop: take the received bytes, let time pass, write the next request."""

from __future__ import annotations

import asyncio
import time
from functools import partial
from math import inf

from cobotwire.client.aio_timers import Timed, timers_of
from cobotwire.client.aio_writing import AsyncWriter
from cobotwire.client.traffic import TrafficListeners
from cobotwire.protocol.errors import LinkError
from cobotwire.session import Exchange, Pending, PendingRequest
from cobotwire.transport.aio import attach
from cobotwire.transport.interface import Transport

# The pause between attempts to write on a full line.
FULL_SECONDS = 0.002
# A timer that is set for a time up to this much too late stays as it is.
TIMER_SLACK = 0.0005


class AsyncSteps:
    """The steps of an exchange; every method is called in the thread of one event loop.

    Attributes:
        exchange: the session.
        transport: the transport on the loop.
        loop, timers: the loop, and the timers that its connections share.
        listeners: receive all traffic of the connection.
        writer: writes requests.
        lost: why the transport is gone; None: it is open.
        deadline: how many seconds a call may take; perhaps inf.
    """

    def __init__(
        self,
        transport: Transport,
        exchange: Exchange,
        listeners: TrafficListeners,
        deadline: float,
    ) -> None:
        """Attach an open transport to the running loop."""
        self.exchange = exchange
        self.deadline = deadline
        self.listeners = listeners
        self.loop = asyncio.get_running_loop()
        self.timers = timers_of(self.loop)
        self._timed = Timed(self._time_passed)
        self.lost: LinkError | None = None
        # The request that the transport did not take at once.
        self._unwritten: PendingRequest | None = None
        self._news: asyncio.Future[None] | None = None
        self.transport = attach(transport, self.turn)
        limited = deadline < inf
        self.writer = AsyncWriter(self.transport, exchange.alignment, listeners, limited)

    def leave_to_parent(self, error: LinkError) -> None:
        """Let every call in a forked child fail."""
        self.lost = error

    def check(self) -> None:
        """Raise a LinkError if the transport is gone."""
        if self.lost is not None:
            raise LinkError(self.lost.url, self.lost.detail)

    def start(self, pending: PendingRequest) -> None:
        """Queue a request. If nothing is under way, take received bytes and send it at once."""
        self.exchange.enqueue(pending)
        self.turn()

    def give_up(self, pending: Pending) -> None:
        """End a request if its caller waits no longer, and leave everything ready for the next.

        It is not sent any more if no byte of it was taken.
        """
        if pending is self._unwritten:
            self.writer.withdraw()
        if not pending.done:
            self.exchange.give_up(pending)
            self.turn()

    def turn(self) -> None:
        """Take the received bytes, let time pass, send the next request, and set the timer."""
        exchange, data, now, full = self.exchange, self._read(), time.monotonic(), False
        events = exchange.advance(data, now)
        if self.lost is not None:
            events += exchange.fail(self.lost, now)
        elif exchange.has_next(now):
            full = not self.writer.is_free()
            exchange.note_full(full)
            if not full:
                self._send_request(now, not data)
        if full:
            self._wake_at(now + FULL_SECONDS)
        else:
            self._set_timer(now)
        if events:
            self.listeners.received(events, now)
            self._end_wait()

    async def wait(self, longest: float) -> None:
        """Wait until something is received, ``longest`` seconds at most."""
        if self._news is None:
            self._news = self.loop.create_future()
        await asyncio.wait([self._news], timeout=longest)

    def _end_wait(self) -> None:
        if self._news is not None:
            self._news.set_result(None)
            self._news = None

    def lose(self, error: LinkError) -> None:
        """End every request: the transport is gone."""
        if self.lost is None:
            self.lost = error
            self.transport.close()
        self._timed.cancel()
        now = time.monotonic()
        self.listeners.received(self.exchange.fail(self.lost, now), now)

    def _read(self) -> bytes:
        if self.lost is None:
            try:
                return self.transport.read()
            except LinkError as error:
                self.lose(error)
                self.listeners.lost(error)
        return b""

    def _send_request(self, now: float, drained: bool) -> None:
        data = self.exchange.outgoing(now, drained)
        pending = self.exchange.sent_last
        if data and pending is not None:
            self._write_request(pending, data)

    def _write_request(self, pending: PendingRequest, data: bytes) -> None:
        try:
            if not self.writer.begin(data, partial(self._written, pending)):
                self._unwritten = pending
        except LinkError as error:
            self.exchange.fail_waiting(error)

    def _written(self, pending: PendingRequest, error: LinkError | None) -> None:
        """Note the end of a write that the transport did not take at once."""
        self._unwritten = None
        self.exchange.written(pending, time.monotonic())
        if error is not None:
            self.exchange.fail_waiting(error)
        self.turn()

    def _set_timer(self, now: float) -> None:
        """Set the timer for the next deadline of the session; the time is ``now``."""
        idle = self.exchange.idle_seconds(now)
        if idle is not None:
            self._wake_at(now + idle)

    def _wake_at(self, due: float) -> None:
        # A timer that goes off too early is set again when it does.
        if self._timed.due > due + TIMER_SLACK:
            self.timers.set(self._timed, due)

    def _time_passed(self) -> None:
        if self.exchange.busy:
            self.turn()
