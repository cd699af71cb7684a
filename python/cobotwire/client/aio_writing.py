"""Write requests on an event loop; if one is cut, note how many of its bytes were written."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from functools import partial
from math import inf

from cobotwire.client.traffic import TrafficListeners
from cobotwire.protocol.errors import LinkError
from cobotwire.session.alignment import Alignment
from cobotwire.transport.interface import AsyncTransport

Done = Callable[[LinkError | None], None]


class AsyncWriter:
    """Writes requests. If the last one was cut, fill bytes that end it precede the next one."""

    def __init__(
        self,
        transport: AsyncTransport,
        alignment: Alignment,
        listeners: TrafficListeners,
        limited: bool,
    ) -> None:
        """Write to ``transport``; ``limited``: a deadline limits the calls."""
        self._transport = transport
        self._limited = limited
        self._alignment = alignment
        self._listeners = listeners

    def is_free(self) -> bool:
        """Return whether a request may be written now.

        If a deadline limits calls, nothing may be queued in the transport: queued bytes would be
        sent even after the deadline.
        """
        return not self._limited or self._transport.is_free()

    async def write(self, request: bytes, ends_by: float = inf) -> None:
        """Write a request, and wait until all of it was taken, but not after ``ends_by``.

        Raises:
            LinkError: the transport is gone, or does not take the bytes.
        """
        loop = asyncio.get_running_loop()
        written: asyncio.Future[None] = loop.create_future()
        if not self.begin(request, partial(_end_wait, written)):
            if ends_by < inf:
                await asyncio.wait([written], timeout=ends_by - time.monotonic())
                if not written.done():
                    self._transport.end_writing()
            await written

    def begin(self, request: bytes, done: Done) -> bool:
        """Write a request; return whether it was taken at once. Otherwise ``done`` is called.

        What was cut is noted even if the caller was cancelled meanwhile.

        Raises:
            LinkError: the transport is gone.
        """
        align = self._alignment.align
        try:
            taken = self._transport.write(align + request, partial(self.end, align, request, done))
        except LinkError as error:
            error.written = self._alignment.cut(align, request, error.written)
            raise
        if taken:
            self._written(align, request)
        return taken

    def end(self, align: bytes, request: bytes, done: Done, error: LinkError | None) -> None:
        """Note the end of a write that was not taken at once."""
        if error is None:
            self._written(align, request)
        else:
            error.written = self._alignment.cut(align, request, error.written)
        done(error)

    def _written(self, align: bytes, request: bytes) -> None:
        if align:
            self._alignment.end()
        self._listeners.sent(align, request)


def _end_wait(written: asyncio.Future[None], error: LinkError | None) -> None:
    if written.done():
        return
    if error is None:
        written.set_result(None)
    else:
        written.set_exception(error)
