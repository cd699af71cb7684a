"""Native calls on an event loop: one writes, reads and decodes at once; none of them waits.

They decide only the usual case, that what comes is one frame and the reply. Everything else goes on
step by step.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

from cobotwire.client.aio_writing import AsyncWriter
from cobotwire.codec.interface import Event, Frame
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
    if not hasattr(exchange.framer, "swap") or not isinstance(transport, PolledTransport):
        return None
    polled = transport.native(exchange.framer)
    return None if polled is None else AsyncNativeCall(polled, exchange, writer, written)


class AsyncNativeCall:
    """Sends plain requests and takes their replies with native calls."""

    def __init__(
        self, polled: NativePolled, exchange: Exchange, writer: AsyncWriter, written: Written
    ) -> None:
        self._polled = polled
        self._exchange = exchange
        self._writer = writer
        self._written = written

    def send(self, pending: PendingRequest) -> list[SessionEvent] | None:
        """Send a plain request; return what has come by then.

        If anything but the reply has come, the request goes on as any other does.

        Returns:
            None if the request was not sent, because it is not alone on the line.
        """
        alone, polled, request = self._exchange.alone, self._polled, pending.request
        now = pending.queued_at
        begun = alone.begin(request, now, pending.policy.grace) if polled.idle else None
        if begun is None:
            return None
        self._starting = pending
        try:
            found = polled.swap(request.frame, request.command.name, self._finish_write)
        except BaseException:
            alone.settle(begun)
            raise
        if found is None:
            alone.end_unsent()
            return None
        return alone.resume(begun, pending, _events(found), now)

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
        found = self._polled.read_reply(waiting.frame, waiting.command.name)
        if found is None:
            return None
        now = time.monotonic()
        if isinstance(found, tuple) and exchange.take_reply(found[0], found[1], now):
            return []
        return exchange.sort(_events(found), fed, now)

    def _finish_write(self, request: bytes, written: int) -> None:
        """Write the rest of a request of which ``written`` bytes were taken."""
        done = partial(self._written, self._starting)
        self._polled.write_rest(request, written, partial(self._writer.end, b"", request, done))


def _events(found: tuple[Frame, object] | list[Event]) -> list[Event]:
    """Return the events of a native call, which may have decoded the only frame."""
    return [found[0]] if isinstance(found, tuple) else found
