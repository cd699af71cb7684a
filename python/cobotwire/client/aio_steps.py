"""The exchange on an event loop: take what has come, let time pass, write the next request."""

from __future__ import annotations

import asyncio
import time
from functools import partial

from cobotwire.client.aio_native_call import native_call
from cobotwire.client.aio_timers import Timed, timers_of
from cobotwire.client.aio_writing import AsyncWriter
from cobotwire.client.traffic import TrafficListeners
from cobotwire.protocol.errors import LinkError
from cobotwire.session import Exchange, Pending, PendingRequest
from cobotwire.transport.aio import attach
from cobotwire.transport.interface import Transport

# A timer that goes off this early or late is left as it is.
TIMER_SLACK = 0.0005


class AsyncSteps:
    """The steps of an exchange; every method is called in the thread of one event loop.

    Attributes:
        transport: the transport on the loop.
        loop, timers: the loop, and the timers that its connections share.
        writer: writes requests.
        native: makes native calls, if there are any.
        lost: why the transport is gone; None: it is there.
    """

    def __init__(
        self, transport: Transport, exchange: Exchange, listeners: TrafficListeners
    ) -> None:
        """Attach an open transport to the running loop."""
        self._exchange = exchange
        self._listeners = listeners
        self.loop = asyncio.get_running_loop()
        self.timers = timers_of(self.loop)
        self._timed = Timed(self._time_passed)
        self.lost: LinkError | None = None
        self._news: asyncio.Future[None] | None = None
        self.transport = attach(transport, self.turn)
        self.writer = AsyncWriter(self.transport, exchange.alignment, listeners)
        self.native = native_call(self.transport, exchange, self.writer, self._written)

    def check(self) -> None:
        """Raise a LinkError if the transport is gone."""
        if self.lost is not None:
            raise LinkError(self.lost.url, self.lost.detail)

    def start(self, pending: PendingRequest) -> None:
        """Send a request at once if nothing else is under way; otherwise queue it.

        What has come already is taken first.
        """
        native = self.native
        if native and pending.request.plain and not self.lost and self._listeners.silent:
            events = native.send(pending)
            if events is not None:
                now = pending.requested_at
                if not pending.done and self._timed.moment > now + pending.shortest_attempt:
                    self._set_timer(now)
                if events:
                    self._listeners.received(events, now)
                    self._end_wait()
                return
        exchange, data = self._exchange, self._read()
        if not data and self.lost is None:
            now = time.monotonic()
            frame = exchange.begin(pending, now)
            if frame:
                self._write_request(pending, frame)
                self._set_timer(now)
                return
        else:
            exchange.enqueue(pending)
        self._advance(data)

    def give_up(self, pending: Pending) -> None:
        """End a request whose caller waits no longer, and leave everything ready for the next."""
        if not pending.done:
            self._exchange.give_up(pending)
            self.turn()

    def turn(self) -> None:
        """Take what has come, let time pass, send the request that is next, and set the timer."""
        native = self.native
        events = None
        if native and not self.lost and self._listeners.silent:
            events = native.receive()
        if events is None:
            self._advance(self._read())
            return
        if self._news is not None:
            self._end_wait()
        if events:
            self._listeners.received(events, time.monotonic())
        if events or self._exchange.busy:
            self._advance(b"", drained=False)

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
        self._listeners.received(self._exchange.fail(self.lost, now), now)

    def _read(self) -> bytes:
        if self.lost is None:
            try:
                return self.transport.read()
            except LinkError as error:
                self.lose(error)
                self._listeners.lost(error)
        return b""

    def _advance(self, data: bytes, drained: bool = True) -> None:
        exchange, now = self._exchange, time.monotonic()
        events, outgoing = exchange.advance(data, now)
        if self.lost is not None:
            events += exchange.fail(self.lost, now)
        elif outgoing:
            self._send_request(now, drained and not data)
        self._set_timer(now)
        if events:
            self._listeners.received(events, now)
            self._end_wait()

    def _send_request(self, now: float, drained: bool) -> None:
        data = self._exchange.outgoing(now, drained)
        pending = self._exchange.sent_last
        if data and pending is not None:
            self._write_request(pending, data)

    def _write_request(self, pending: PendingRequest, data: bytes) -> None:
        try:
            self.writer.begin(data, partial(self._written, pending))
        except LinkError as error:
            self._exchange.fail_waiting(error)

    def _written(self, pending: PendingRequest, error: LinkError | None) -> None:
        """Note that a write ended that was not taken at once."""
        self._exchange.written(pending, time.monotonic())
        if error is not None:
            self._exchange.fail_waiting(error)
        self.turn()

    def _set_timer(self, now: float) -> None:
        idle = self._exchange.idle_seconds(now)
        if idle is not None:
            self._wake_at(now + idle)

    def _wake_at(self, moment: float) -> None:
        # If it goes off earlier, it is set again then.
        if self._timed.moment > moment + TIMER_SLACK:
            self.timers.set(self._timed, moment)

    def _time_passed(self) -> None:
        if self._exchange.busy:
            self.turn()
