"""One transport on an event loop, shared by the tasks of the loop."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial

from cobotwire.client.opening import OpenPort, PortOpener
from cobotwire.client.port_memory import PortMemory
from cobotwire.client.traffic import TrafficListener, TrafficListeners
from cobotwire.codec.interface import Event, Frame
from cobotwire.protocol.errors import CaptureError, LinkError, UsageError
from cobotwire.session import EncodedRequest, Exchange, Pending, PendingRequest, RetryPolicy
from cobotwire.transport import forks
from cobotwire.transport.aio import NativePolled, PolledTransport, attach
from cobotwire.transport.interface import AsyncTransport
from cobotwire.transport.timing import times_of

# A timer that goes off this early or late is left as it is.
TIMER_SLACK = 0.0005


class AsyncConnection:
    """An exchange over a transport; every method is called in the thread of one event loop."""

    now = staticmethod(time.monotonic)
    sleep = staticmethod(asyncio.sleep)

    def __init__(
        self,
        opener: PortOpener,
        exchange: Exchange,
        trace: TrafficListener | None,
    ) -> None:
        """Note what to open; :meth:`open` opens it.

        Raises:
            UsageError: the port is not allowed, or is a transport with a clock of its own; or the
                path of the recording is not allowed.
        """
        opener.check()
        port = opener.port
        if not times_of(port).real:
            message = "asyncio runs in real time, and this transport has a clock of its own"
            raise UsageError("port", port, message=message)
        self._opener = opener
        self._port: OpenPort | None = None
        self.url = port if isinstance(port, str) else port.url
        self.listeners = TrafficListeners(trace, self.url)
        self._exchange = exchange
        self._alignment = exchange.alignment
        self._attached: AsyncTransport | None = None
        # Set if a native call can write, read and decode.
        self._polled: NativePolled | None = None
        self._lost: LinkError | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._timer_at = 0.0
        # Set when something was received.
        self._news = asyncio.Event()
        forks.watch(self)

    async def open(self) -> None:
        """Open the port, unless it is open.

        Raises:
            UsageError: the port or baud rate is not allowed, or the file of the recording exists.
            LinkError: the port does not exist, or cannot be opened.
        """
        if self._attached is not None:
            return
        self._loop = asyncio.get_running_loop()
        # Connecting may take a while: a thread does it, and the loop goes on.
        work = self._loop.run_in_executor(None, self._opener.open)
        try:
            self._port = await asyncio.shield(work)
        except asyncio.CancelledError:
            work.add_done_callback(_close_unwanted)
            raise
        transport = self._port.transport
        self._memory = PortMemory(transport)
        self._exchange.take_over(self._memory.recall())
        self._attached = attach(transport, self._turn)
        if hasattr(self._exchange.framer, "swap") and isinstance(self._attached, PolledTransport):
            self._polled = self._attached.native(self._exchange.framer)

    async def send(self, request: EncodedRequest, ack_within: float | None) -> None:
        """Send a one-way request at once; wait ``ack_within`` seconds for its acknowledgement."""
        transport = self._transport()
        data, pending = self._exchange.send_one_way(request, self.now(), ack_within)
        try:
            await self._write(transport, data)
            self._turn()
            if pending is not None:
                await self._await(pending)
                pending.result()
        finally:
            if pending is not None:
                self._exchange.give_up(pending)

    async def request(
        self, request: EncodedRequest, policy: RetryPolicy, wait: float | None
    ) -> PendingRequest:
        """Send a request and wait until it is done.

        Raises:
            LinkError: the connection is not open.
        """
        transport = self._transport()
        pending = PendingRequest(request, wait, policy, self.now())
        try:
            self._start(pending, transport)
            if not pending.done:
                over: asyncio.Future[None] = self._loop.create_future()
                pending.when_done(partial(_wake, over))
                await over
        finally:
            # A call that was cancelled leaves everything ready for the next one.
            if not pending.done:
                self._exchange.give_up(pending)
                self._turn()
        return pending

    async def listen(self, seconds: float, done: Callable[[], bool] | None = None) -> None:
        """Wait while the loop reads what comes without a request, and reports it to listeners.

        Until then, ``done`` ends the wait as soon as it returns True after something has come.

        Raises:
            LinkError: the transport is gone.
        """
        self._transport()
        until = self.now() + seconds
        while (left := until - self.now()) > 0 and not (done and done()):
            if self._lost is not None:
                raise LinkError(self._lost.url, self._lost.detail)
            self._news.clear()
            with suppress(TimeoutError):
                await asyncio.wait_for(self._news.wait(), min(left, 0.05))

    def close(self) -> None:
        """Close the transport; calls that wait get a LinkError. Closing twice is harmless.

        Raises:
            CaptureError: the recording is incomplete; everything is closed all the same.
        """
        if self._attached is not None and self._port is not None:
            self._attached.close()
            self._memory.leave(self._exchange.leave(self.now()))
            self._lose(LinkError(self.url, "it is closed"))
            self._port.close_recording()

    def leave_to_parent(self) -> None:
        """Let every call in a forked child fail: loop and transport are those of the parent."""
        if self._attached is not None and self._lost is None:
            self._lost = LinkError(self.url, f"cannot be used: {forks.opened_by_parent()}")
            self._memory.leave_to_parent()

    def _transport(self) -> AsyncTransport:
        if self._attached is None:
            raise LinkError(self.url, "it is not open: use `async with`, or await open()")
        return self._attached

    async def _await(self, pending: Pending) -> None:
        if not pending.done:
            over: asyncio.Future[None] = self._loop.create_future()
            pending.when_done(partial(_wake, over))
            await over

    async def _write(self, transport: AsyncTransport, data: bytes) -> None:
        if self._lost is not None:
            raise LinkError(self._lost.url, self._lost.detail)
        over: asyncio.Future[None] = self._loop.create_future()
        if not self._begin_write(transport, data, partial(_end_wait, over)):
            await over

    def _begin_write(
        self, transport: AsyncTransport, request: bytes, done: Callable[[LinkError | None], None]
    ) -> bool:
        """Write a request; return whether it was taken at once. Otherwise ``done`` is called.

        What was cut is noted even if the caller was cancelled meanwhile.
        """
        align = self._alignment.align
        try:
            taken = transport.write(align + request, partial(self._end_write, align, request, done))
        except LinkError as error:
            error.written = self._alignment.cut(align, request, error.written)
            raise
        if taken:
            self._written(align, request)
        return taken

    def _end_write(
        self,
        align: bytes,
        request: bytes,
        done: Callable[[LinkError | None], None],
        error: LinkError | None,
    ) -> None:
        """Note the end of a write that was not taken at once."""
        if error is None:
            self._written(align, request)
        else:
            error.written = self._alignment.cut(align, request, error.written)
        done(error)

    def _written(self, align: bytes, request: bytes) -> None:
        if align:
            self._alignment.end()
        self.listeners.sent(align, request)

    def _start(self, pending: PendingRequest, transport: AsyncTransport) -> None:
        """Send a request at once if nothing else is under way; otherwise queue it.

        What has come already is taken first.
        """
        if self._start_alone(pending):
            return
        exchange, data = self._exchange, self._read(transport)
        if not data and self._lost is None:
            now = self.now()
            frame = exchange.begin(pending, now)
            if frame:
                self._write_request(pending, frame)
                self._set_timer(now)
                return
        else:
            exchange.enqueue(pending)
        self._advance(data)

    def _start_alone(self, pending: PendingRequest) -> bool:
        """Send a request that is alone, with one native call; return whether it was sent.

        If anything but the reply has come then, the request goes on as any other does.
        """
        alone, request, polled = self._exchange.alone, pending.request, self._polled
        if polled is None or not request.plain or self._lost or not self.listeners.silent:
            return False
        now = pending.queued_at
        begun = alone.begin(request, now, pending.policy.grace) if polled.idle else None
        if begun is None:
            return False
        self._starting = pending
        try:
            found = polled.swap(request.frame, request.command.name, self._finish_write)
        except BaseException:
            alone.settle(begun)
            raise
        if found is None:
            alone.end_unsent()
            return False
        events = alone.resume(begun, pending, _events(found), now)
        self._set_timer(now)
        if events:
            self.listeners.received(events, now)
            self._news.set()
        return True

    def _finish_write(self, request: bytes, written: int) -> None:
        """Write the rest of a request of which so many bytes were taken."""
        assert self._polled is not None, "it has written the beginning"
        done = partial(self._request_written, self._starting)
        self._polled.write_rest(request, written, partial(self._end_write, b"", request, done))

    def _turn(self) -> None:
        """Take what has come, let time pass, send the request that is next, and set the timer."""
        exchange, polled = self._exchange, self._polled
        waiting = exchange.waiting_plainly
        if waiting is None or polled is None or self._lost or not self.listeners.silent:
            self._advance(self._read(self._transport()))
            return
        fed = exchange.framer.fed
        found = polled.read_reply(waiting.frame, waiting.command.name)
        if found is None:
            # Time has passed, or the transport is gone.
            self._advance(self._read(self._transport()))
            return
        now = self.now()
        if isinstance(found, tuple) and exchange.take_reply(found[0], found[1], now):
            self._news.set()
            if exchange.busy:
                self._advance(b"", drained=False)
            return
        self.listeners.received(exchange.sort(_events(found), fed, now), now)
        self._news.set()
        self._advance(b"", drained=False)

    def _read(self, transport: AsyncTransport) -> bytes:
        if self._lost is None:
            try:
                return transport.read()
            except LinkError as error:
                self._lose(error)
                self.listeners.lost(error)
        return b""

    def _advance(self, data: bytes, drained: bool = True) -> None:
        exchange, now = self._exchange, self.now()
        events, outgoing = exchange.advance(data, now)
        if self._lost is not None:
            events += exchange.fail(self._lost, now)
        elif outgoing:
            self._send_request(now, drained and not data)
        self._set_timer(now)
        if events:
            self.listeners.received(events, now)
            self._news.set()

    def _set_timer(self, now: float) -> None:
        idle = self._exchange.idle_seconds(now)
        if idle is not None:
            self._wake_at(now + idle)

    def _send_request(self, now: float, drained: bool) -> None:
        data = self._exchange.outgoing(now, drained)
        pending = self._exchange.sent_last
        if data and pending is not None:
            self._write_request(pending, data)

    def _write_request(self, pending: PendingRequest, data: bytes) -> None:
        try:
            self._begin_write(self._transport(), data, partial(self._request_written, pending))
        except LinkError as error:
            self._exchange.fail_waiting(error)

    def _request_written(self, pending: PendingRequest, error: LinkError | None) -> None:
        """Note that a write ended that was not taken at once."""
        self._exchange.written(pending, self.now())
        if error is not None:
            self._exchange.fail_waiting(error)
        self._turn()

    def _wake_at(self, moment: float) -> None:
        if self._timer is not None:
            if self._timer_at <= moment + TIMER_SLACK:
                # It goes off early enough, and is set again then.
                return
            self._timer.cancel()
        self._timer_at = moment
        self._timer = self._loop.call_later(moment - self.now(), self._time_passed)

    def _time_passed(self) -> None:
        self._timer = None
        self._turn()

    def _lose(self, error: LinkError) -> None:
        """End every request: the transport is gone."""
        if self._lost is None:
            self._lost = error
            self._transport().close()
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        now = self.now()
        self.listeners.received(self._exchange.fail(self._lost, now), now)


def _events(found: tuple[Frame, object] | list[Event]) -> list[Event]:
    """Return the events of a native call, which may have decoded the only frame."""
    return [found[0]] if isinstance(found, tuple) else found


def _close_unwanted(work: asyncio.Future[OpenPort]) -> None:
    if not work.cancelled() and work.exception() is None:
        # An incomplete recording was logged.
        with suppress(CaptureError):
            work.result().close()


def _wake(over: asyncio.Future[None]) -> None:
    if not over.done():
        over.set_result(None)


def _end_wait(over: asyncio.Future[None], error: LinkError | None) -> None:
    if over.done():
        return
    if error is None:
        over.set_result(None)
    else:
        over.set_exception(error)
