"""Whatever else pyserial opens: ``rfc2217://``, ``loop://``, ``spy://``; and ports on Windows."""

from __future__ import annotations

import logging
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import serial

from cobotwire.errors import LinkError
from cobotwire.transport.descriptor import READ_SIZE, reason_of, write_limit
from cobotwire.transport.serial.opening import ask_low_latency, configure, opening
from cobotwire.transport.waiting import Waiter

# A backend without a descriptor is read in slices of this length.
SLICE_SECONDS = 0.01

_log = logging.getLogger("cobotwire.link")


class UrlLink:
    """A link through pyserial's own reading and writing; see ``transport.interface.Link``."""

    def __init__(self, url: str, baudrate: int) -> None:
        """Open the URL.

        Raises:
            UsageError: the URL or baud rate is none that pyserial knows.
            LinkError: it cannot be opened.
        """
        scheme, separator, _ = url.partition("://")
        self.url = url
        self.kind = scheme.lower() if separator else "serial"
        self.low_latency = False
        self._baudrate = baudrate
        self._closed = True
        self._port: Any = None
        self._waiter = Waiter()
        self.reopen()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.url}{', closed' if self._closed else ''}>"

    def reopen(self) -> None:
        """Close and open again."""
        self.close()
        with opening(self.url):
            port: Any = serial.serial_for_url(self.url, do_not_open=True)
            configure(port, self._baudrate)
            if os.name == "posix" and isinstance(port, serial.Serial):
                # What stands behind spy:// is a port as any other.
                port.exclusive = True
            port.open()
            self._port = port
            self._descriptor = _descriptor(port)
            if self._descriptor is None:
                port.timeout = SLICE_SECONDS
            self.low_latency = ask_low_latency(port)
        self._waiter = Waiter()
        self._closed = False
        _log.info("%s: opened", self.url)

    def write(self, data: bytes) -> None:
        """Send all of ``data``. If it fails, pyserial does not tell how much was taken."""
        with self._faults("cannot be written"):
            limit = write_limit(len(data), self._baudrate)
            if self._port.write_timeout != limit:
                self._port.write_timeout = limit
            self._port.write(data)

    def write_some(self, data: bytes) -> int:
        """All of ``data``: these backends have no other way. It may take as long as a write."""
        self.write(data)
        return len(data)

    def read(self, timeout: float) -> bytes:
        """What has come, as soon as there is something."""
        with self._faults("cannot be read"):
            if self._descriptor is None:
                return self._read_in_slices(time.monotonic() + timeout)
            # Not by pyserial's timeout: to change it configures the port anew, with every call.
            if not self._waiter.wait(self._descriptor, timeout):
                return b""
            if self._closed:
                raise OSError
            data: bytes = self._port.read(READ_SIZE)
            return data

    def _read_in_slices(self, deadline: float) -> bytes:
        while True:
            waiting = self._port.in_waiting
            if not waiting and time.monotonic() >= deadline:
                return b""
            data: bytes = self._port.read(waiting or 1)
            if data:
                return data

    def fileno(self) -> int | None:
        """None: even where there is a descriptor, pyserial must read, since spy:// shows it."""
        with self._faults("cannot be waited for"):
            return None

    def close(self) -> None:
        """Give the port back."""
        self._closed = True
        self._waiter.wake()
        # What is gone already, or closed by another thread right now, need not be given back.
        with suppress(Exception):
            self._port.close()

    @contextmanager
    def _faults(self, what: str) -> Iterator[None]:
        if self._closed:
            raise LinkError(self.url, f"{what}: it is closed")
        try:
            yield
        # Asked of a port that goes away, pyserial fails in as many ways as it has backends: its
        # rfc2217 with an AttributeError, its posix port with termios.error or TypeError.
        except Exception as error:
            reason = "it was closed meanwhile" if self._closed else reason_of(error)
            raise LinkError(self.url, f"{what}: {reason}") from error


def _descriptor(port: Any) -> int | None:
    """What can be waited for; pyserial's other backends raise something or have no such method."""
    try:
        descriptor: int = port.fileno()
    except (OSError, AttributeError):
        return None
    # Windows waits for sockets only.
    return descriptor if os.name == "posix" else None
