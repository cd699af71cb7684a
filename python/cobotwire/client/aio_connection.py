"""Share one transport among the tasks of an event loop; asyncio clients call this."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from math import inf

from cobotwire.client.aio_polling import AsyncPoller
from cobotwire.client.aio_steps import FULL_SECONDS, AsyncSteps
from cobotwire.client.firmware import ReportedFirmware
from cobotwire.client.opening import OpenPort, PortOpener
from cobotwire.client.persisted_state import PersistedSession
from cobotwire.client.traffic import TrafficListener, TrafficListeners
from cobotwire.protocol.errors import CaptureError, LinkError, UsageError
from cobotwire.session import EncodedRequest, Exchange, Pending, PendingRequest, RetryPolicy
from cobotwire.transport import forks
from cobotwire.transport.timing import times_of

# The longest wait, after which a listening task checks whether the transport is gone.
LISTEN_SECONDS = 0.05


class AsyncConnection:
    """An exchange over a transport; every method is called in the thread of one event loop."""

    now = staticmethod(time.monotonic)
    sleep = staticmethod(asyncio.sleep)

    def __init__(
        self,
        opener: PortOpener,
        exchange: Exchange,
        trace: TrafficListener | None,
        deadline: float,
    ) -> None:
        """Store the arguments; :meth:`open` opens the port.

        A call may take ``deadline`` seconds; ``inf`` sets no limit.

        Raises:
            UsageError: the port or the path of the recording is not allowed, or the transport has a
                clock of its own.
        """
        opener.check()
        port = opener.port
        if not times_of(port).real:
            message = "asyncio runs in real time, and this transport has a clock of its own"
            raise UsageError("port", port, message=message)
        self._opener = opener
        self._port: OpenPort | None = None
        self.url = port if isinstance(port, str) else port.url
        self.firmware = ReportedFirmware()
        self.listeners = TrafficListeners(trace, self.url)
        self._exchange = exchange
        # Held by follow(), so that only one runs at a time.
        self.follows = threading.Lock()
        self._deadline = deadline
        self._steps: AsyncSteps | None = None
        forks.watch(self)

    async def open(self) -> None:
        """Open the port, unless it is open.

        Raises:
            UsageError: the port or baud rate is not allowed, or the file of the recording exists.
            LinkError: the port does not exist, or cannot be opened.
        """
        if self._steps is not None:
            return
        self._loop = asyncio.get_running_loop()
        # Connecting may take long, so a thread does it, and the loop continues.
        work = self._loop.run_in_executor(None, self._opener.open)
        try:
            self._port = await asyncio.shield(work)
        except asyncio.CancelledError:
            work.add_done_callback(_close_unwanted)
            raise
        transport = self._port.transport
        self._persisted = PersistedSession(transport, self._exchange.persist)
        self._exchange.restore(self._persisted.recall())
        self._steps = AsyncSteps(transport, self._exchange, self.listeners, self._deadline)

    async def send(
        self, request: EncodedRequest, ack_within: float | None, deadline: float | None = None
    ) -> None:
        """Send a one-way request at once; wait ``ack_within`` seconds for its acknowledgement.

        ``deadline`` replaces the deadline of other calls.
        """
        steps, called_at = self._opened(), self.now()
        ends_by = called_at + (self._deadline if deadline is None else deadline)
        while ends_by < inf and steps.lost is None and not steps.writer.is_free():
            left = ends_by - self.now()
            if left <= 0:
                raise steps.exchange.unsent(request, self.now() - called_at)
            await asyncio.sleep(min(left, FULL_SECONDS))
        exchange = steps.exchange
        data, pending = exchange.send_one_way(request, self.now(), ack_within, ends_by)
        try:
            steps.check()
            await steps.writer.write(data, ends_by, request.command.is_stop)
            steps.turn()
            if pending is not None:
                await self._wait(pending)
                self.firmware.result(pending)
        finally:
            if pending is not None:
                steps.exchange.give_up(pending)

    async def request(
        self,
        request: EncodedRequest,
        policy: RetryPolicy,
        wait: float | None,
        deadline: float | None = None,
    ) -> PendingRequest:
        """Send a request and wait until it is done.

        ``deadline`` limits this call in addition to the deadline of the client.

        Raises:
            LinkError: the connection is not open.
        """
        steps = self._opened()
        now = self.now()
        longest = self._deadline if deadline is None else min(deadline, self._deadline)
        pending = PendingRequest(request, wait, policy, now, now + longest)
        try:
            steps.start(pending)
            await self._wait(pending)
        finally:
            # A call that was cancelled leaves everything ready for the next one.
            steps.give_up(pending)
        return pending

    def poller(self, closed: Callable[[], bool]) -> AsyncPoller:
        """Return a poller, which sends the requests of a stream until ``closed`` returns True."""
        return AsyncPoller(self._opened, closed)

    async def listen(self, seconds: float, done: Callable[[], bool] | None = None) -> None:
        """Wait, while the loop reads what arrives and reports it to listeners.

        The wait ends early if ``done`` returns True after something has come.

        Raises:
            LinkError: the transport is gone.
        """
        steps = self._opened()
        until = self.now() + seconds
        while (left := until - self.now()) > 0 and not (done and done()):
            steps.check()
            await steps.wait(min(left, LISTEN_SECONDS))

    def send_only_stops(self) -> None:
        """Send only ``stop`` and ``halt`` from now on; other calls of all tasks get a LinkError."""
        self._exchange.send_only_stops(self.url)

    def close(self) -> None:
        """Close the transport; calls that wait get a LinkError. Closing twice is harmless.

        Raises:
            CaptureError: the recording is incomplete; everything is closed nevertheless.
        """
        if self._steps is not None and self._port is not None:
            try:
                self._steps.transport.close()
            finally:
                self._persisted.end()
                self._steps.lose(LinkError(self.url, "it is closed"))
                self._port.close_recording()

    def leave_to_parent(self) -> None:
        """Let every call in a forked child fail: loop and transport belong to the parent."""
        if self._steps is not None and self._steps.lost is None:
            error = LinkError(self.url, f"cannot be used: {forks.opened_by_parent()}")
            self._steps.leave_to_parent(error)
            self._persisted.leave_to_parent()

    def _opened(self) -> AsyncSteps:
        if self._steps is None:
            raise LinkError(self.url, "it is not open: use `async with`, or await open()")
        return self._steps

    async def _wait(self, pending: Pending) -> None:
        if not pending.done:
            done: asyncio.Future[None] = self._loop.create_future()
            pending.when_done(partial(_wake, done))
            await done


def _close_unwanted(work: asyncio.Future[OpenPort]) -> None:
    if not work.cancelled() and work.exception() is None:
        # An incomplete recording was logged.
        with suppress(CaptureError):
            work.result().close()


def _wake(done: asyncio.Future[None]) -> None:
    if not done.done():
        done.set_result(None)
