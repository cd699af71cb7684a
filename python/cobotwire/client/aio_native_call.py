"""Native calls on an event loop: one writes, reads and decodes at once; none of them waits.

They decide only the usual case, that what comes is one frame and the reply. Everything else goes on
step by step.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from typing import Any

from cobotwire.client.aio_writing import AsyncWriter
from cobotwire.protocol.errors import LinkError
from cobotwire.session import Exchange, PendingRequest, SessionEvent
from cobotwire.transport.aio import NativePolled, PolledTransport
from cobotwire.transport.interface import AsyncTransport

Written = Callable[[PendingRequest, LinkError | None], None]


def native_call(
    transport: AsyncTransport, exchange: Exchange, writer: AsyncWriter, written: Written
) -> AsyncNativeCall | None:
    """Return how the native module makes calls; None: transport or codec do not allow it.

    ``written`` is called when a write ends that was not taken at once.
    """
    if not hasattr(exchange.framer, "read_reply") or not isinstance(transport, PolledTransport):
        return None
    polled = transport.native(exchange.framer)
    return None if polled is None else AsyncNativeCall(polled, exchange, writer, written)


class AsyncNativeCall:
    """Sends plain requests and takes their replies with native calls.

    Attributes:
        polled: the native calls of the transport.
    """

    def __init__(
        self, polled: NativePolled, exchange: Exchange, writer: AsyncWriter, written: Written
    ) -> None:
        self.polled = polled
        self._exchange = exchange
        self._writer = writer
        self._written = written

    def send(self, pending: PendingRequest) -> list[SessionEvent] | None:
        """Send a plain request; return what has come then, except for its reply.

        Returns:
            None if it was not sent, because it is not alone on the line.
        """
        polled, exchange, request = self.polled, self._exchange, pending.request
        if polled.unwritten:
            return None
        now = time.monotonic()
        fed = exchange.alone.wait_on(pending, now)
        if fed is None:
            return None
        found = polled.send(request.frame, request.command.name)
        if found is None:
            exchange.alone.take_back(pending)
            return None
        if isinstance(found, int):
            self.write_rest(pending, found)
            return []
        return self._take(found, fed, now) if found else []

    def receive(self) -> list[SessionEvent] | None:
        """Read what has come for the plain request that waits; return what it is.

        Returns:
            None if nothing was read: no plain request waits, nothing has come, or the transport is
            gone. Of the reply alone nothing is reported, and the list is empty.
        """
        exchange = self._exchange
        waiting = exchange.waiting_plainly
        if waiting is None:
            return None
        fed = exchange.framer.fed
        found = self.polled.read_reply(waiting.frame, waiting.command.name)
        return None if found is None else self._take(found, fed, time.monotonic())

    def _take(self, found: Any, fed: int, now: float) -> list[SessionEvent]:
        if isinstance(found, tuple):
            frame, fields = found
            if self._exchange.take_reply(frame, fields, now):
                return []
            found = [frame]
        return self._exchange.sort(found, fed, now)

    def write_rest(self, pending: PendingRequest, taken: int) -> None:
        """Write what follows the first ``taken`` bytes of a request."""
        request, done = pending.request.frame, partial(self._written, pending)
        self.polled.write_rest(request, taken, partial(self._writer.end, b"", request, done))
