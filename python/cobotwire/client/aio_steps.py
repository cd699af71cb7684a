"""The exchange on an event loop: take what has come, let time pass, write the next request."""

from __future__ import annotations

import asyncio
import time
from functools import partial

from cobotwire.client.aio_native_call import native_call
from cobotwire.client.aio_writing import AsyncWriter
from cobotwire.client.traffic import TrafficListeners
from cobotwire.protocol.errors import LinkError
from cobotwire.session import Exchange, PendingRequest
from cobotwire.transport.aio import attach
from cobotwire.transport.interface import Transport

# A timer that goes off this early or late is left as it is.
TIMER_SLACK = 0.0005


class AsyncSteps:
    """The steps of an exchange; every method is called in the thread of one event loop.

    Attributes:
        transport: the transport on the loop.
        writer: writes requests.
        native: makes native calls, if there are any.
        lost: why the transport is gone; None: it is there.
        news: set when something was received.
    """

    def __init__(
        self, transport: Transport, exchange: Exchange, listeners: TrafficListeners
    ) -> None:
        """Attach an open transport to the running loop."""
        self._exchange = exchange
        self._listeners = listeners
        self._loop = asyncio.get_running_loop()
        self._timer: asyncio.TimerHandle | None = None
        self._timer_at = 0.0
        self.lost: LinkError | None = None
        self.news = asyncio.Event()
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
                now = pending.queued_at
                self._set_timer(now)
                if events:
                    self._listeners.received(events, now)
                    self.news.set()
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

    def turn(self) -> None:
        """Take what has come, let time pass, send the request that is next, and set the timer."""
        native = self.native
        events = None
        if native and not self.lost and self._listeners.silent:
            events = native.receive()
        if events is None:
            self._advance(self._read())
            return
        self.news.set()
        if events:
            self._listeners.received(events, time.monotonic())
        if events or self._exchange.busy:
            self._advance(b"", drained=False)

    def lose(self, error: LinkError) -> None:
        """End every request: the transport is gone."""
        if self.lost is None:
            self.lost = error
            self.transport.close()
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
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
            self.news.set()

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
        if self._timer is not None:
            if self._timer_at <= moment + TIMER_SLACK:
                # It goes off early enough, and is set again then.
                return
            self._timer.cancel()
        self._timer_at = moment
        self._timer = self._loop.call_later(moment - time.monotonic(), self._time_passed)

    def _time_passed(self) -> None:
        self._timer = None
        self.turn()
