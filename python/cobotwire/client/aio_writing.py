"""Write requests on an event loop; if one is cut, note how many of its bytes were written."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from math import inf

from cobotwire.client.traffic import TrafficListeners
from cobotwire.protocol.errors import LinkError
from cobotwire.session.alignment import Alignment
from cobotwire.transport.interface import AsyncTransport

Done = Callable[[LinkError | None], None]


class Write:
    """A request to be written.

    Attributes:
        align: the bytes that precede it; known once it was given to the transport.
        done: called at its end, unless the transport took it at once.
        stops: whether it stops the arm: neither another write nor its caller takes it back.
    """

    __slots__ = ("align", "done", "request", "stops")

    def __init__(self, request: bytes, done: Done, stops: bool) -> None:
        """Store the arguments."""
        self.align, self.request, self.done, self.stops = b"", request, done, stops


class AsyncWriter:
    """Writes requests. If the last one was cut, fill bytes that end it precede the next one.

    The transport has one write at a time. The others wait here, because only the end of a write
    tells which bytes must precede the next one.
    """

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
        # The write that the transport has, and those that wait, oldest first.
        self._current: Write | None = None
        self._waiting: deque[Write] = deque()
        # Whether the current write is ended by its caller.
        self._withdrawing = False

    def is_free(self) -> bool:
        """Return whether a request may be written now.

        If a deadline limits calls, the transport must also have room: what it does not take at once
        would be sent even after the deadline.
        """
        return self._current is None and (not self._limited or self._transport.is_free())

    async def write(self, request: bytes, ends_by: float = inf, stops: bool = False) -> None:
        """Write a request, and wait until all of it was taken, but not after ``ends_by``.

        If the caller is cancelled before a byte of the request was taken, it is never sent, unless
        it ``stops`` the arm.

        Raises:
            LinkError: the transport is gone, or does not take the bytes.
        """
        loop = asyncio.get_running_loop()
        written: asyncio.Future[None] = loop.create_future()
        write = Write(request, partial(_end_wait, written), stops)
        if self._begin(write):
            return
        try:
            if ends_by < inf:
                await asyncio.wait([written], timeout=ends_by - time.monotonic())
                if not written.done():
                    self._end_current(write, inf)
            await written
        except asyncio.CancelledError:
            written.cancel()
            if not stops:
                self._withdraw(write)
            raise

    def begin(self, request: bytes, done: Done) -> bool:
        """Write a request; return whether it was taken at once. Otherwise ``done`` is called.

        What was cut is noted even if the caller was cancelled meanwhile.

        Raises:
            LinkError: the transport is gone.
        """
        return self._begin(Write(request, done, False))

    def _begin(self, write: Write) -> bool:
        if self._current is not None:
            self._waiting.append(write)
            return False
        return self._start(write)

    def _start(self, write: Write) -> bool:
        write.align = align = self._alignment.align
        try:
            taken = self._transport.write(align + write.request, partial(self._end, write))
        except LinkError as error:
            error.written = self._alignment.cut(align, write.request, error.written)
            raise
        if taken:
            self._written(write)
        else:
            self._current = write
        return taken

    def _end(self, write: Write, error: LinkError | None) -> None:
        """Note the end of a write that was not taken at once, and start the next one."""
        self._current = None
        ended: list[tuple[Write, LinkError | None]] = [(write, error)]
        try:
            if error is None:
                self._written(write)
            else:
                error.written = self._alignment.cut(write.align, write.request, error.written)
                if not self._withdrawing:
                    ended += [(each, _unsent(error)) for each in self._waiting if not each.stops]
                    self._waiting = deque(each for each in self._waiting if each.stops)
        finally:
            # A traffic listener may have raised; no caller must wait for ever.
            try:
                self._start_waiting(ended)
            finally:
                for each, why in ended:
                    each.done(why)

    def _start_waiting(self, ended: list[tuple[Write, LinkError | None]]) -> None:
        """Start the writes that wait, until the transport keeps one; add those that ended."""
        raised: Exception | None = None
        while self._waiting and self._current is None:
            following = self._waiting.popleft()
            why: LinkError | None = None
            try:
                self._start(following)
            except LinkError as failed:
                why = failed
            except Exception as error:  # of a traffic listener
                raised = raised or error
            if following is not self._current:
                ended.append((following, why))
        if raised is not None:
            raise raised

    def withdraw(self) -> None:
        """Do not send the request that was begun last, if no byte of it was taken."""
        if self._current is not None:
            self._withdraw(self._current)

    def _withdraw(self, write: Write) -> None:
        """Do not send a write, if no byte of its request was taken."""
        if write in self._waiting:
            self._waiting.remove(write)
        else:
            self._end_current(write, len(write.align))

    def _end_current(self, write: Write, most: float) -> None:
        """End a write if the transport has it, and took at most ``most`` of its bytes."""
        if write is self._current:
            self._withdrawing = True
            try:
                self._transport.end_writing(most)
            finally:
                self._withdrawing = False

    def _written(self, write: Write) -> None:
        if write.align:
            self._alignment.end()
        self._listeners.sent(write.align, write.request)


def _unsent(error: LinkError) -> LinkError:
    """Return the error of a request that was not begun because an earlier one failed."""
    return LinkError(error.url, error.detail, 0)


def _end_wait(written: asyncio.Future[None], error: LinkError | None) -> None:
    if written.done():
        return
    if error is None:
        written.set_result(None)
    else:
        written.set_exception(error)
