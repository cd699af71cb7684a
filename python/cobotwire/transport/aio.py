"""Links on an event loop: watched by the loop where that can be, else read by a thread."""

from __future__ import annotations

import asyncio
import queue
import threading
from collections import deque
from collections.abc import Callable
from contextlib import suppress

from cobotwire.errors import LinkError
from cobotwire.transport.interface import AsyncLink, PollableTransport, Transport

WRITE_TIMEOUT = 1.0
# How long the reading thread takes at most to hear that the link was closed.
SLICE_SECONDS = 0.1

Told = Callable[[LinkError | None], None]


def attach(transport: Transport, ready: Callable[[], None]) -> AsyncLink:
    """Bind an open transport to the running loop; ``ready`` is called when there is to be read."""
    if isinstance(transport, PollableTransport):
        descriptor = transport.fileno()
        if descriptor is not None:
            # Some loops (Windows' default one) cannot watch descriptors.
            with suppress(NotImplementedError):
                return PolledLink(transport, descriptor, ready)
    return ThreadedLink(transport, ready)


class PolledLink:
    """Watched by the loop; see :class:`cobotwire.transport.interface.AsyncLink`."""

    def __init__(
        self, transport: PollableTransport, descriptor: int, ready: Callable[[], None]
    ) -> None:
        self._transport = transport
        self._descriptor = descriptor
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(descriptor, ready)
        # Whole writes that were not taken yet, oldest first; the first one perhaps in part.
        self._waiting: deque[tuple[bytes, Told]] = deque()
        self._stuck: asyncio.TimerHandle | None = None
        self._closed = False

    def read(self) -> bytes:
        """What has come by now."""
        return self._transport.read(0)

    def write(self, data: bytes, told: Told) -> bool:
        """Send ``data`` behind what was sent before."""
        if not self._waiting:
            taken = self._transport.write_some(data)
            if taken == len(data):
                return True
            data = data[taken:]
            self._loop.add_writer(self._descriptor, self._write_on)
            self._stuck = self._loop.call_later(WRITE_TIMEOUT, self._give_up)
        self._waiting.append((data, told))
        return False

    def _write_on(self) -> None:
        data, told = self._waiting[0]
        try:
            taken = self._transport.write_some(data)
        except LinkError as error:
            self._end_writing(error)
            return
        if taken < len(data):
            self._waiting[0] = (data[taken:], told)
            return
        self._waiting.popleft()
        told(None)
        if not self._waiting:
            self._end_writing(None)

    def _give_up(self) -> None:
        detail = f"does not take what is written: no byte was taken in {WRITE_TIMEOUT:.1f} s"
        self._end_writing(LinkError(self._transport.url, detail))

    def _end_writing(self, error: LinkError | None) -> None:
        self._loop.remove_writer(self._descriptor)
        if self._stuck is not None:
            self._stuck.cancel()
        waiting, self._waiting = self._waiting, deque()
        for _, told in waiting:
            told(error)

    def close(self) -> None:
        """Stop watching and give the link back."""
        if not self._closed:
            self._closed = True
            self._loop.remove_reader(self._descriptor)
            self._end_writing(LinkError(self._transport.url, "was closed"))
            self._transport.close()


class ThreadedLink:
    """Read and written by two threads; see :class:`cobotwire.transport.interface.AsyncLink`."""

    def __init__(self, transport: Transport, ready: Callable[[], None]) -> None:
        self._transport = transport
        self._loop = asyncio.get_running_loop()
        self._ready = ready
        self._come: queue.SimpleQueue[bytes | LinkError] = queue.SimpleQueue()
        self._going: queue.SimpleQueue[tuple[bytes, Told] | None] = queue.SimpleQueue()
        self._lost: LinkError | None = None
        self._closed = False
        for work in (self._read_on, self._write_on):
            threading.Thread(target=work, name=f"cobotwire {transport.url}", daemon=True).start()

    def read(self) -> bytes:
        """What has come by now."""
        data = b""
        with suppress(queue.Empty):
            while self._lost is None:
                come = self._come.get_nowait()
                if isinstance(come, LinkError):
                    self._lost = come
                else:
                    data += come
        if self._lost is not None and not data:
            raise LinkError(self._lost.url, self._lost.detail)
        return data

    def write(self, data: bytes, told: Told) -> bool:
        """Send ``data`` behind what was sent before."""
        self._going.put((data, told))
        return False

    def close(self) -> None:
        """Stop watching and give the link back."""
        if not self._closed:
            self._closed = True
            self._going.put(None)
            self._transport.close()

    def _read_on(self) -> None:
        while not self._closed:
            try:
                come: bytes | LinkError = self._transport.read(SLICE_SECONDS)
            except LinkError as error:
                come = error
            if come:
                self._come.put(come)
                self._in_loop(self._ready)
            if isinstance(come, LinkError):
                return

    def _write_on(self) -> None:
        while (going := self._going.get()) is not None:
            data, told = going
            try:
                self._transport.write(data)
            except LinkError as error:
                self._in_loop(told, error)
            else:
                self._in_loop(told, None)

    def _in_loop(self, call: Callable[..., None], *arguments: object) -> None:
        # A loop that was closed meanwhile has nobody who waits.
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(call, *arguments)
