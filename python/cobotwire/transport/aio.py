"""Transports on an event loop: watched by the loop where possible, otherwise read by a thread."""

from __future__ import annotations

import asyncio
import queue
import threading
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from math import inf

from cobotwire.protocol.errors import LinkError
from cobotwire.transport import forks
from cobotwire.transport.interface import AsyncTransport, PollableTransport, Transport
from cobotwire.transport.loop_readers import readers_of
from cobotwire.transport.waiting import has_room

# A write fails when no byte of it was taken for this long.
WRITE_TIMEOUT = 1.0
# The pause between attempts to write, in seconds.
RETRY_SECONDS = 0.02
# After at most this long the reading thread notices that the transport was closed.
SLICE_SECONDS = 0.1

Done = Callable[[LinkError | None], None]


def attach(transport: Transport, ready: Callable[[], None]) -> AsyncTransport:
    """Bind an open transport to the running loop; ``ready`` is called when data has come."""
    if isinstance(transport, PollableTransport):
        descriptor = transport.fileno()
        if descriptor is not None:
            # Some loops (Windows' default one) cannot watch descriptors.
            with suppress(NotImplementedError):
                return PolledTransport(transport, descriptor, ready)
    return ThreadedTransport(transport, ready)


class PolledTransport:
    """An :class:`AsyncTransport` that the loop watches."""

    def __init__(
        self, transport: PollableTransport, descriptor: int, ready: Callable[[], None]
    ) -> None:
        self._transport = transport
        self._descriptor = descriptor
        self._loop = asyncio.get_running_loop()
        self._readers = readers_of(self._loop)
        self._readers.add(descriptor, ready)
        # Writes that were not taken yet, oldest first, and how much of the first one was taken.
        self._unwritten: deque[tuple[bytes, Done]] = deque()
        self._taken = 0
        self._progress_at = 0.0
        self._timer: asyncio.TimerHandle | None = None
        self._closed = False
        forks.watch(self)

    def read(self) -> bytes:
        """Return the bytes received by now."""
        return self._transport.read(0)

    def write(self, data: bytes, done: Done) -> bool:
        """Send ``data`` after what was sent before."""
        if self._closed:
            raise LinkError(self._transport.url, "was closed")
        if not self._unwritten:
            taken = self._transport.write_some(data)
            if taken == len(data):
                return True
            self._taken = taken
            self._progress_at = self._loop.time()
            self._loop.add_writer(self._descriptor, self._write_on)
            self._retry_later()
        self._unwritten.append((data, done))
        return False

    def is_free(self) -> bool:
        """Return whether everything that was written was taken, and there is room for more."""
        return not self._unwritten and has_room(self._transport)

    def end_writing(self, most: float = inf) -> None:
        """Stop sending what was not taken yet, if at most ``most`` bytes of it were taken."""
        if self._unwritten and self._taken <= most:
            taken = f"only {self._taken} of {len(self._unwritten[0][0])} bytes were taken in time"
            self._end_writing(LinkError(self._transport.url, f"cannot be written: {taken}"))

    def _write_on(self) -> None:
        data, done = self._unwritten[0]
        try:
            taken = self._transport.write_some(data[self._taken :])
        except LinkError as error:
            self._end_writing(error)
            return
        if taken:
            self._progress_at = self._loop.time()
        self._taken += taken
        if self._taken < len(data):
            return
        self._unwritten.popleft()
        self._taken = 0
        done(None)
        if not self._unwritten:
            self._end_writing(None)

    def _retry_later(self) -> None:
        # A tty is reported as writable only when most of its buffer is free; it takes bytes before.
        if self._timer is not None:
            self._timer.cancel()
        self._timer = self._loop.call_later(RETRY_SECONDS, self._retry)

    def _retry(self) -> None:
        if self._unwritten:
            self._write_on()
        if self._unwritten:
            if self._loop.time() - self._progress_at < WRITE_TIMEOUT:
                self._retry_later()
            else:
                detail = f"cannot be written: no byte was taken in {WRITE_TIMEOUT:.1f} s"
                self._end_writing(LinkError(self._transport.url, detail))

    def _end_writing(self, error: LinkError | None) -> None:
        """End all writes; those after the first one were not begun."""
        self._loop.remove_writer(self._descriptor)
        if self._timer is not None:
            self._timer.cancel()
        waiting = list(self._unwritten)
        self._unwritten.clear()
        taken, self._taken = self._taken, 0
        for _, done in waiting:
            # Each caller raises an error of its own.
            done(None if error is None else LinkError(error.url, error.detail, taken))
            taken = 0

    def close(self) -> None:
        """Stop watching and close the transport."""
        if not self._closed:
            self._closed = True
            self._readers.remove(self._descriptor)
            self._end_writing(LinkError(self._transport.url, "was closed"))
            self._transport.close()

    def leave_to_parent(self) -> None:
        """Count as closed, and do not touch the loop: a forked child shares its epoll."""
        self._closed = True


class ThreadedTransport:
    """An :class:`AsyncTransport` that two threads read and write."""

    def __init__(self, transport: Transport, ready: Callable[[], None]) -> None:
        self._transport = transport
        self._loop = asyncio.get_running_loop()
        self._ready = ready
        self._read_queue: queue.SimpleQueue[bytes | LinkError] = queue.SimpleQueue()
        # Each write, with the number of failures that the loop knew of when the write was queued.
        self._write_queue: queue.SimpleQueue[tuple[bytes, Done, int] | None] = queue.SimpleQueue()
        self._failures = self._unwritten = 0
        self._lost: LinkError | None = None
        self._closed = False
        forks.watch(self)
        for work in (self._read_on, self._write_on):
            threading.Thread(target=work, name=f"cobotwire {transport.url}", daemon=True).start()

    def read(self) -> bytes:
        """Return the bytes received by now."""
        data = b""
        with suppress(queue.Empty):
            while self._lost is None:
                arrived = self._read_queue.get_nowait()
                if isinstance(arrived, LinkError):
                    self._lost = arrived
                else:
                    data += arrived
        if self._lost is not None and not data:
            raise LinkError(self._lost.url, self._lost.detail)
        return data

    def write(self, data: bytes, done: Done) -> bool:
        """Send ``data`` after what was sent before."""
        if self._closed:
            raise LinkError(self._transport.url, "was closed")
        self._unwritten += 1
        self._write_queue.put((data, partial(self._end, done), self._failures))
        return False

    def is_free(self) -> bool:
        """Return whether everything that was written was taken."""
        return not self._unwritten

    def end_writing(self, most: float = inf) -> None:
        """Do nothing: the thread that writes cannot be interrupted."""

    def _end(self, done: Done, error: LinkError | None) -> None:
        self._unwritten -= 1
        done(error)

    def close(self) -> None:
        """Stop watching and close the transport."""
        if not self._closed:
            self._closed = True
            self._write_queue.put(None)
            self._transport.close()

    def leave_to_parent(self) -> None:
        """Count as closed: the threads do not exist in a forked child."""
        self._closed = True

    def _read_on(self) -> None:
        while not self._closed:
            try:
                arrived: bytes | LinkError = self._transport.read(SLICE_SECONDS)
            except Exception as error:
                arrived = self._link_error(error)
            if arrived:
                self._read_queue.put(arrived)
                self._in_loop(self._ready)
            if isinstance(arrived, LinkError):
                return

    def _write_on(self) -> None:
        failures = 0
        error: LinkError | None = None
        while (next_write := self._write_queue.get()) is not None:
            data, done, known = next_write
            if error is not None and known < failures:
                # This write was queued before the loop knew that an earlier one was cut. The peer
                # would take its bytes for the rest of the cut request.
                self._in_loop(done, LinkError(error.url, error.detail))
                continue
            try:
                self._transport.write(data)
            except Exception as failed:
                error, failures = self._link_error(failed), failures + 1
                self._in_loop(self._fail_write, done, error)
            else:
                self._in_loop(done, None)

    def _link_error(self, error: Exception) -> LinkError:
        """Return any error as a LinkError: if it ended the thread, callers would wait for ever."""
        if isinstance(error, LinkError):
            return error
        return LinkError(self._transport.url, f"raised {error!r}")

    def _fail_write(self, done: Done, error: LinkError) -> None:
        self._failures += 1
        done(error)

    def _in_loop(self, call: Callable[..., None], *arguments: object) -> None:
        # The loop may be closed by now. Then nothing waits for the call.
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(call, *arguments)
