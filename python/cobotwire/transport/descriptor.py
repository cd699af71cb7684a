"""What serial ports and sockets have in common: a descriptor that never blocks."""

from __future__ import annotations

import errno
import os
import threading
import time
from abc import ABC, abstractmethod
from typing import NoReturn

from cobotwire.protocol.errors import LinkError
from cobotwire.transport import forks
from cobotwire.transport.log import Log
from cobotwire.transport.waiting import Waiter, native_calls

READ_SIZE = 4096
# The time limit of a write: this, plus twice the time that the line needs for the bytes.
WRITE_SECONDS = 1.0
# Start bit, eight data bits, stop bit.
BITS_A_BYTE = 10

_log = Log("cobotwire.transport")


def write_limit(size: int, baudrate: int) -> float:
    """Return how many seconds a write of ``size`` bytes may take until the transport is stuck."""
    return WRITE_SECONDS + 2 * size * BITS_A_BYTE / baudrate


class DescriptorTransport(ABC):
    """An :class:`OpenedTransport` over a descriptor; subclasses implement the last methods."""

    kind = ""
    low_latency = False

    def __init__(self, url: str, baudrate: int) -> None:
        self.url = url
        self._baudrate = baudrate
        self._closed = True
        self._why_closed = "it is closed"
        # -1 while it is closed: no wait accepts that.
        self._descriptor = -1
        self._waiter = Waiter()
        self._native = native_calls()
        # Reentrant, since a signal may close the transport in the very thread that waits for it.
        self._reading = threading.RLock()
        self._writing = threading.RLock()
        self.reopen()
        forks.watch(self)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.url}{', closed' if self._closed else ''}>"

    def read(self, timeout: float) -> bytes:
        """Return the received bytes, as soon as there are any."""
        with self._reading:
            if self._closed:
                self._must_be_open("cannot be read")
            try:
                if self._native is None:
                    data = self._read_within(timeout)
                else:
                    alarm = self._waiter.alarm() if timeout > 0 else -1
                    data = (
                        None
                        if alarm is None
                        else self._native.read_within(self._descriptor, timeout, alarm)
                    )
            except (OSError, ValueError) as error:
                self._fail("cannot be read", error)
            if data:
                return data
            if data is not None:
                raise LinkError(self.url, f"cannot be read: {self._end_of_data()}")
            self._must_be_open("cannot be read", "it was closed meanwhile")
            return b""

    def _read_within(self, timeout: float) -> bytes | None:
        """Return the received bytes; None if nothing was received, empty at the end of the data."""
        deadline = time.monotonic() + timeout
        while self._waiter.wait(self._descriptor, timeout) and not self._closed:
            try:
                return self._receive(READ_SIZE)
            except BlockingIOError:
                timeout = deadline - time.monotonic()
                if timeout <= 0:
                    break
        return None

    def write(self, data: bytes) -> None:
        """Send all of ``data``; if it fails, the LinkError's ``written`` says how much was sent."""
        with self._writing:
            written = self._write_now(data)
            if written < len(data):
                self._write_rest(data, written)

    def _write_rest(self, data: bytes, written: int) -> None:
        limit = write_limit(len(data), self._baudrate)
        deadline = time.monotonic() + limit
        interrupt: KeyboardInterrupt | None = None
        while written < len(data):
            try:
                self._wait_for_room(deadline)
                written += self.write_some(data[written:])
            except KeyboardInterrupt as error:
                # The frame is finished first: after half a frame, the arm would miss the next one.
                interrupt = error
            except LinkError as error:
                error.written = written
                raise
            if written < len(data) and time.monotonic() >= deadline:
                taken = f"only {written} of {len(data)} bytes were taken in {limit:.1f} s"
                raise LinkError(self.url, f"cannot be written: {taken}", written)
        if interrupt is not None:
            raise interrupt

    def _wait_for_room(self, deadline: float) -> None:
        try:
            self._waiter.wait(self._descriptor, deadline - time.monotonic(), writing=True)
        except (OSError, ValueError) as error:
            self._fail("cannot be written", error)
        self._must_be_open("cannot be written", "it was closed meanwhile")

    def write_some(self, data: bytes) -> int:
        """Send as much of ``data`` as possible without waiting; return how many bytes."""
        with self._writing:
            return self._write_now(data)

    def _write_now(self, data: bytes) -> int:
        if self._closed:
            self._must_be_open("cannot be written")
        try:
            if self._native is not None:
                return self._native.write_now(self._descriptor, data)
            return self._send(data)
        except BlockingIOError:
            return 0
        except (OSError, ValueError) as error:
            self._fail("cannot be written", error)

    def fileno(self) -> int | None:
        """Return the descriptor that an event loop can wait for."""
        self._must_be_open("cannot be waited for")
        return self._descriptor

    def close(self) -> None:
        """Close it; a read or write in another thread ends at once."""
        self._closed = True
        self._waiter.wake()
        # The descriptor is closed only when no thread waits for it any longer, since another file
        # may get its number immediately.
        with self._reading, self._writing:
            self._waiter.close()
            self._descriptor = -1
            self._release()

    def reopen(self) -> None:
        """Close it and open it again."""
        with self._reading, self._writing:
            self.close()
            self._descriptor = self._connect()
            self._waiter = Waiter()
            self._closed, self._why_closed = False, "it is closed"
        _log.info("%s: opened", self.url)

    def leave_to_parent(self) -> None:
        """Close a forked child's copies, which the parent does not notice."""
        # Another thread of the parent may have held the locks; it does not exist here.
        self._reading, self._writing = threading.RLock(), threading.RLock()
        if not self._closed:
            self._closed, self._why_closed = True, forks.opened_by_parent()
            self._waiter.close()
            self._descriptor = -1
            self._release()

    def _must_be_open(self, what: str, reason: str = "") -> None:
        if self._closed:
            raise LinkError(self.url, f"{what}: {reason or self._why_closed}")

    def _fail(self, what: str, error: Exception) -> NoReturn:
        reason = "it was closed meanwhile" if self._closed else reason_of(error)
        raise LinkError(self.url, f"{what}: {reason}") from error

    def _end_of_data(self) -> str:
        """Return why a transport that is ready to be read has no data."""
        return "it is gone"

    @abstractmethod
    def _connect(self) -> int:
        """Open it and return its non-blocking descriptor; raise what ``open_transport`` raises."""

    @abstractmethod
    def _release(self) -> None:
        """Close the descriptor, if there is one; raise nothing."""

    def _receive(self, size: int) -> bytes:
        return os.read(self._descriptor, size)

    def _send(self, data: bytes) -> int:
        return os.write(self._descriptor, data)


def reason_of(error: BaseException | None) -> str:
    """Return what went wrong, in the words of the system."""
    number = getattr(error, "errno", None)
    if number == errno.EBUSY or "exclusively lock" in str(error):
        return "another program has it open"
    file = getattr(error, "filename", None)
    # The errors of name look-ups have numbers of their own, below zero.
    known = isinstance(number, int) and number > 0
    text = os.strerror(number) if known and number else str(error) or type(error).__name__
    if not known and getattr(error, "strerror", None):
        text = str(getattr(error, "strerror", ""))
    return f"{text} ({file})" if file else text
