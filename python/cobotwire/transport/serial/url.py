"""Other transports of pyserial: ``rfc2217://``, ``loop://``, ``spy://``; and ports on Windows."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import serial

from cobotwire.protocol.errors import LinkError
from cobotwire.transport import forks
from cobotwire.transport.descriptor import READ_SIZE, reason_of, write_limit
from cobotwire.transport.log import Log
from cobotwire.transport.serial.opening import configure, opening, request_low_latency
from cobotwire.transport.waiting import Waiter

# A backend without a descriptor is read in slices of this length.
SLICE_SECONDS = 0.01

_log = Log("cobotwire.transport")


class UrlTransport:
    """An :class:`OpenedTransport` that pyserial itself reads and writes."""

    def __init__(self, url: str, baudrate: int) -> None:
        """Open the URL.

        Raises:
            UsageError: pyserial does not know the URL or baud rate.
            LinkError: it cannot be opened.
        """
        scheme, separator, _ = url.partition("://")
        self.url = url
        self.kind = scheme.lower() if separator else "serial"
        self.low_latency = False
        self._baudrate = baudrate
        self._closed = True
        self._why_closed = "it is closed"
        self._port: Any = None
        self._waiter = Waiter()
        self.reopen()
        forks.watch(self)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.url}{', closed' if self._closed else ''}>"

    def reopen(self) -> None:
        """Close it and open it again."""
        self.close()
        with opening(self.url, self.url if self.kind == "serial" else ""):
            port: Any = serial.serial_for_url(self.url, do_not_open=True)
            configure(port, self._baudrate)
            if os.name == "posix" and isinstance(port, serial.Serial):
                # spy:// opens a port like any other.
                port.exclusive = True
            port.open()
            self._port = port
            self._descriptor = _descriptor(port)
            if self._descriptor is None:
                port.timeout = SLICE_SECONDS
            self.low_latency = request_low_latency(port)
        self._waiter = Waiter()
        self._closed, self._why_closed = False, "it is closed"
        _log.info("%s: opened", self.url)

    def write(self, data: bytes) -> None:
        """Send all of ``data``. If that fails, pyserial does not tell how much was taken."""
        with self._faults("cannot be written", written=None):
            limit = write_limit(len(data), self._baudrate)
            if self._port.write_timeout != limit:
                self._port.write_timeout = limit
            self._port.write(data)

    def write_some(self, data: bytes) -> int:
        """Send all of ``data``, which may take as long as a write: there is no other way."""
        self.write(data)
        return len(data)

    def read(self, timeout: float) -> bytes:
        """Return the received bytes, as soon as there are any."""
        with self._faults("cannot be read"):
            if self._descriptor is None:
                return self._read_in_slices(time.monotonic() + timeout)
            # Not by pyserial's timeout: changing it configures the port again with every call.
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
        """Return None: pyserial must read even a port with a descriptor: spy:// shows each read."""
        with self._faults("cannot be waited for"):
            return None

    def close(self) -> None:
        """Close the port."""
        self._closed = True
        self._waiter.wake()
        # A port that is gone, or that another thread closes right now, cannot be closed.
        with suppress(Exception):
            self._port.close()

    def leave_to_parent(self) -> None:
        """Close a forked child's copies, which the parent does not notice."""
        if self._closed:
            return
        self._closed, self._why_closed = True, forks.opened_by_parent()
        self._waiter.close()
        if (connection := getattr(self._port, "_socket", None)) is None:
            with suppress(Exception):
                self._port.close()
        else:
            # rfc2217 would shut the connection down, for the parent as well.
            self._port.close = _nothing
            connection.close()
        self._port = None

    @contextmanager
    def _faults(self, what: str, written: int | None = 0) -> Iterator[None]:
        if self._closed:
            raise LinkError(self.url, f"{what}: {self._why_closed}")
        try:
            yield
        # On a port that goes away, each backend of pyserial fails in its own way: rfc2217 with an
        # AttributeError, a POSIX port with termios.error or TypeError.
        except Exception as error:
            reason = "it was closed meanwhile" if self._closed else reason_of(error)
            raise LinkError(self.url, f"{what}: {reason}", written) from error


def _nothing() -> None:
    """Close nothing."""


def _descriptor(port: Any) -> int | None:
    """Return the descriptor to wait for; None for a backend without one."""
    try:
        descriptor: int = port.fileno()
    except (OSError, AttributeError):
        return None
    # Windows can wait only for sockets.
    return descriptor if os.name == "posix" else None
