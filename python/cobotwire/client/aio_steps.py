"""The exchange on an event loop: take what has come, let time pass, write the next request."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from functools import partial
from math import inf
from typing import TYPE_CHECKING

from cobotwire.client.aio_native_call import native_call
from cobotwire.client.aio_timers import Timed, timers_of
from cobotwire.client.aio_writing import AsyncWriter
from cobotwire.client.traffic import TrafficListeners
from cobotwire.codec.interface import Event
from cobotwire.protocol.errors import LinkError
from cobotwire.protocol.lazy import import_aside
from cobotwire.session import Exchange, Pending, PendingRequest
from cobotwire.transport.aio import attach
from cobotwire.transport.interface import Transport

if TYPE_CHECKING:
    from cobotwire.client.aio_lending import Lending, NativeSlot, Slots

# How often a line that takes no bytes is tried again.
FULL_SECONDS = 0.002
# A timer that goes off this early or late is left as it is.
TIMER_SLACK = 0.0005


class AsyncSteps:
    """The steps of an exchange; every method is called in the thread of one event loop.

    Attributes:
        transport: the transport on the loop.
        loop, timers: the loop, and the timers that its connections share.
        listeners: get what passes the connection.
        writer: writes requests.
        native: makes native calls, if there are any.
        lost: why the transport is gone; None: it is there.
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
        self._exchange = exchange
        self.deadline = deadline
        self.listeners = listeners
        self._lending: Lending | None = None
        self.loop = asyncio.get_running_loop()
        self.timers = timers_of(self.loop)
        self._timed = Timed(self._time_passed)
        self.lost: LinkError | None = None
        self._news: asyncio.Future[None] | None = None
        self.transport = attach(transport, self.turn)
        limited = deadline < inf
        self.writer = AsyncWriter(self.transport, exchange.alignment, listeners, limited)
        self.native = native_call(self.transport, exchange, self.writer, self._written)

    @property
    def exchange(self) -> Exchange:
        """The session, which is not lent now."""
        self.take_back()
        return self._exchange

    def take_back(self) -> None:
        """Use the session in Python, if it was lent; what is under way goes on in it."""
        if self._lending is not None:
            self._lending.take_back()

    def stream_slot(self, slots: Slots) -> NativeSlot | None:
        """Return what sends the plain requests of a stream; None: only the session does."""
        if self.native is None or self.lost is not None:
            return None
        if self._lending is None:
            # Imported here: most programs open no stream.
            import_aside("cobotwire.client.aio_lending")
            from cobotwire.client.aio_lending import Lending

            try:
                self._lending = Lending(self, self._exchange, self.native)
            except LinkError:
                # It is closed, which the next use reports.
                return None
        return self._lending.slot(slots)

    def hand_over(self, slot: NativeSlot) -> None:
        """Have a thread send what a slot of a stream plans next, if that helps."""
        if self._lending is not None:
            self._lending.hand_over(slot)

    def leave_to_parent(self, error: LinkError) -> None:
        """Let every call in a forked child fail."""
        # A thread of the parent may have held the lock of the native object.
        lending, self._lending, self.lost = self._lending, None, error
        if lending is not None:
            lending.leave_to_parent()

    def check(self) -> None:
        """Raise a LinkError if the transport is gone."""
        if self.lost is not None:
            raise LinkError(self.lost.url, self.lost.detail)

    def start(self, pending: PendingRequest) -> None:
        """Send a request at once if nothing else is under way; otherwise queue it.

        What has come already is taken first.
        """
        native, exchange, free = self.native, self.exchange, self.writer.is_free()
        if native and free and pending.request.plain and not self.lost and self.listeners.silent:
            events = native.send(pending)
            if events is not None:
                now = pending.requested_at
                soonest = min(now + pending.shortest_attempt, pending.ends_by)
                if not pending.done and self._timed.moment > soonest:
                    self.set_timer(now)
                if events:
                    self.listeners.received(events, now)
                    self._end_wait()
                return
        data = self._read()
        if free and not data and self.lost is None:
            now = time.monotonic()
            frame = exchange.begin(pending, now)
            if frame:
                self._write_request(pending, frame)
                self.set_timer(now)
                return
        else:
            exchange.enqueue(pending)
        self._advance(data)

    def give_up(self, pending: Pending) -> None:
        """End a request whose caller waits no longer, and leave everything ready for the next."""
        if not pending.done:
            self.exchange.give_up(pending)
            self.turn()

    def turn(self) -> None:
        """Take what has come, let time pass, send the request that is next, and set the timer."""
        native, exchange = self.native, self.exchange
        events = None
        if native and not self.lost and self.listeners.silent:
            events = native.receive()
        if events is None:
            self._advance(self._read())
            return
        if self._news is not None:
            self._end_wait()
        if events:
            self.listeners.received(events, time.monotonic())
        if events or exchange.busy:
            self._advance(b"", drained=False)

    def sort(self, received: Sequence[Event], fed: int) -> None:
        """Take what has come; the framer had been fed ``fed`` bytes before."""
        now = time.monotonic()
        events = self.exchange.sort(received, fed, now)
        self._end_wait()
        self.listeners.received(events, now)
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
        self.listeners.received(self.exchange.fail(self.lost, now), now)

    def _read(self) -> bytes:
        if self.lost is None:
            try:
                return self.transport.read()
            except LinkError as error:
                self.lose(error)
                self.listeners.lost(error)
        return b""

    def _advance(self, data: bytes, drained: bool = True) -> None:
        exchange, now, full = self._exchange, time.monotonic(), False
        events, outgoing = exchange.advance(data, now)
        if self.lost is not None:
            events += exchange.fail(self.lost, now)
        elif outgoing:
            full = not self.writer.is_free()
            exchange.note_full(full)
            if not full:
                self._send_request(now, drained and not data)
        if full:
            self._wake_at(now + FULL_SECONDS)
        else:
            self.set_timer(now)
        if events:
            self.listeners.received(events, now)
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
        exchange = self.exchange
        exchange.written(pending, time.monotonic())
        if error is not None:
            exchange.fail_waiting(error)
        self.turn()

    def set_timer(self, now: float) -> None:
        """Have time pass for the session when the next thing is to be done; it is ``now``."""
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
