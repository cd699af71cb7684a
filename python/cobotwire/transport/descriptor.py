"""What a serial port and a socket have in common: a descriptor that never blocks."""

from __future__ import annotations

import errno
import logging
import os
import threading
import time
from abc import ABC, abstractmethod
from typing import NoReturn

from cobotwire.errors import LinkError
from cobotwire.transport.waiting import Waiter

READ_SIZE = 4096
# A write may take twice the time that the line needs for the bytes, and this long besides.
WRITE_SECONDS = 1.0
# Start bit, eight data bits, stop bit.
BITS_A_BYTE = 10

_log = logging.getLogger("cobotwire.link")


def write_limit(size: int, baudrate: int) -> float:
    """How many seconds a write of ``size`` bytes may take before the link counts as stuck."""
    return WRITE_SECONDS + 2 * size * BITS_A_BYTE / baudrate


class DescriptorLink(ABC):
    """See :class:`cobotwire.transport.interface.Link`; the kinds differ in the last methods."""

    kind = ""
    low_latency = False

    def __init__(self, url: str, baudrate: int) -> None:
        self.url = url
        self._baudrate = baudrate
        self._closed = True
        self._waiter = Waiter()
        # Reentrant, since a signal may close the link in the very thread that waits for it.
        self._reading = threading.RLock()
        self._writing = threading.RLock()
        self.reopen()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.url}{', closed' if self._closed else ''}>"

    def read(self, timeout: float) -> bytes:
        """What has come, as soon as there is something."""
        deadline = time.monotonic() + timeout
        with self._reading:
            self._must_be_open("cannot be read")
            try:
                while self._waiter.wait(self._descriptor(), timeout):
                    if self._closed:
                        break
                    try:
                        data = self._receive(READ_SIZE)
                    except BlockingIOError:
                        timeout = deadline - time.monotonic()
                        if timeout > 0:
                            continue
                        return b""
                    if not data:
                        raise LinkError(self.url, f"cannot be read: {self._end_of_data()}")
                    return data
            except LinkError:
                raise
            except (OSError, ValueError) as error:
                self._fail("cannot be read", error)
            self._must_be_open("cannot be read", "it was closed meanwhile")
            return b""

    def write(self, data: bytes) -> None:
        """Send all of ``data``; what was taken of it is told by the LinkError's ``written``."""
        with self._writing:
            written = self.write_some(data)
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
                # The frame is finished first: behind half of one, the next would not be heard.
                interrupt = error
            except LinkError as error:
                error.written += written
                raise
            if written < len(data) and time.monotonic() >= deadline:
                taken = f"of {len(data)} bytes {written} were taken in {limit:.1f} s"
                raise LinkError(self.url, f"does not take what is written: {taken}", written)
        if interrupt is not None:
            raise interrupt

    def _wait_for_room(self, deadline: float) -> None:
        try:
            self._waiter.wait(self._descriptor(), deadline - time.monotonic(), writing=True)
        except (OSError, ValueError) as error:
            self._fail("cannot be written", error)
        self._must_be_open("cannot be written", "it was closed meanwhile")

    def write_some(self, data: bytes) -> int:
        """As much of ``data`` as the link takes without waiting."""
        with self._writing:
            self._must_be_open("cannot be written")
            try:
                return self._send(data)
            except BlockingIOError:
                return 0
            except (OSError, ValueError) as error:
                self._fail("cannot be written", error)

    def fileno(self) -> int | None:
        """What select() waits for."""
        self._must_be_open("cannot be waited for")
        return self._descriptor()

    def close(self) -> None:
        """Give the link back; whoever waits for it in another thread hears of it at once."""
        self._closed = True
        self._waiter.wake()
        # Only when nobody waits any longer: the number of a closed descriptor may be another
        # file's a moment later.
        with self._reading, self._writing:
            self._waiter.close()
            self._release()

    def reopen(self) -> None:
        """Close and open again."""
        with self._reading, self._writing:
            self.close()
            self._connect()
            self._waiter = Waiter()
            self._closed = False
        _log.info("%s: opened", self.url)

    def _must_be_open(self, what: str, reason: str = "it is closed") -> None:
        if self._closed:
            raise LinkError(self.url, f"{what}: {reason}")

    def _fail(self, what: str, error: Exception) -> NoReturn:
        reason = "it was closed meanwhile" if self._closed else reason_of(error)
        raise LinkError(self.url, f"{what}: {reason}") from error

    def _end_of_data(self) -> str:
        """Why a link that has something to read reads as nothing."""
        return "it is gone"

    @abstractmethod
    def _connect(self) -> None:
        """Open it, without blocking mode; raises the errors of ``open_link``."""

    @abstractmethod
    def _release(self) -> None:
        """Give the descriptor back, if there is one; raises nothing."""

    @abstractmethod
    def _descriptor(self) -> int:
        """The descriptor; -1 for a closed one, which no wait takes."""

    def _receive(self, size: int) -> bytes:
        return os.read(self._descriptor(), size)

    def _send(self, data: bytes) -> int:
        return os.write(self._descriptor(), data)


def reason_of(error: BaseException | None) -> str:
    """What went wrong, in the system's words."""
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
