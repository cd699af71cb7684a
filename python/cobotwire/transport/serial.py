"""Whatever pyserial opens: ports, ``socket://``, ``loop://``, ``rfc2217://``. Its only importer."""

from __future__ import annotations

import errno
import os
import select
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any
from urllib.parse import urlsplit

import serial

from cobotwire.errors import LinkError, UsageError

WRITE_TIMEOUT = 1.0
READ_SIZE = 4096
# A backend that select() does not know is read in slices of this length.
SLICE_SECONDS = 0.01
HIGHEST_BAUDRATE = 2**31 - 1
NETWORK = ("socket://", "rfc2217://")


class SerialTransport:
    """A link through pyserial; see :class:`cobotwire.transport.interface.Transport`."""

    def __init__(self, url: str, baudrate: int) -> None:
        """Open the port.

        Raises:
            UsageError: the URL or baud rate is none that pyserial knows.
            LinkError: the port is not there, or cannot be opened.
        """
        _check_url(url)
        whole = isinstance(baudrate, int) and not isinstance(baudrate, bool)
        if not whole or not 0 < baudrate <= HIGHEST_BAUDRATE:
            raise UsageError("baudrate", baudrate, f"a whole number 1..{HIGHEST_BAUDRATE}")
        self.url = url
        self._closed = False
        try:
            self._port = _open(url, baudrate)
            self._selectable = _selectable(self._port)
            if not self._selectable:
                self._port.timeout = SLICE_SECONDS
        # Each backend of pyserial fails in its own way, from KeyError to termios.error.
        except Exception as error:
            cause = _innermost(error)
            if isinstance(cause, ValueError | KeyError) and not isinstance(cause, OSError):
                raise UsageError("port", url, f"what pyserial opens ({cause})") from None
            raise LinkError(url, f"cannot be opened: {_reason(error)}") from error

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""
        with self._faults("cannot be written"):
            self._port.write(data)

    def read(self, timeout: float) -> bytes:
        """What has come, as soon as there is something."""
        with self._faults("cannot be read"):
            if not self._selectable:
                return self._read_in_slices(time.monotonic() + timeout)
            # Not by pyserial's timeout: to change it configures the port anew, with every call.
            ready, _, _ = select.select([self._port.fileno()], [], [], max(0.0, timeout))
            data: bytes = self._port.read(READ_SIZE) if ready else b""
            return data

    def _read_in_slices(self, deadline: float) -> bytes:
        while True:
            waiting = self._port.in_waiting
            if not waiting and time.monotonic() >= deadline:
                return b""
            data: bytes = self._port.read(waiting or 1)
            if data:
                return data

    def close(self) -> None:
        """Give the port back."""
        self._closed = True
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
        # socket with an AttributeError, its posix port with termios.error or TypeError.
        except Exception as error:
            reason = "it was closed meanwhile" if self._closed else _reason(error)
            raise LinkError(self.url, f"{what}: {reason}") from error


def _check_url(url: object) -> None:
    if not isinstance(url, str) or not url or not url.isprintable():
        raise UsageError("port", url, "the name of a serial port, or a URL, in printable text")
    if url.lower().startswith(NETWORK):
        try:
            parts = urlsplit(url)
            if parts.hostname and parts.port:
                return
        except ValueError:
            pass
        raise UsageError("port", url, "scheme://host:port with a port number 1..65535")


def _open(url: str, baudrate: int) -> Any:
    port: Any = serial.serial_for_url(url, do_not_open=True)
    port.baudrate = baudrate
    port.timeout = 0
    port.write_timeout = WRITE_TIMEOUT
    # Asserted, these lines hold the controller of some boards in reset.
    port.dtr = False
    port.rts = False
    if "://" not in url:
        # Two processes on one port would mix their bytes into each other's frames.
        port.exclusive = True
    port.open()
    return port


def _selectable(port: Any) -> bool:
    try:
        select.select([port.fileno()], [], [], 0)
    except (OSError, ValueError):
        return False
    return True


def _innermost(error: BaseException) -> BaseException:
    """What went wrong first: pyserial wraps it in errors, and some of these fail in themselves."""
    while error.__context__ is not None:
        error = error.__context__
    return error


def _reason(error: Exception) -> str:
    number = getattr(error, "errno", None)
    if number == errno.EBUSY or "exclusively lock" in str(error):
        return "another program has it open"
    file = getattr(error, "filename", None)
    text = os.strerror(number) if number else str(error) or type(error).__name__
    return f"{text} ({file})" if file else text
