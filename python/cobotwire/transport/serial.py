"""Whatever pyserial opens: ports, ``socket://``, ``loop://``, ``rfc2217://``. Its only importer."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager

import serial

from cobotwire.errors import LinkError, UsageError

WRITE_TIMEOUT = 1.0
OPENING = "cannot be opened"


class SerialTransport:
    """A link through pyserial; see :class:`cobotwire.transport.interface.Transport`."""

    def __init__(self, url: str, baudrate: int) -> None:
        """Open the port.

        Raises:
            UsageError: the URL or baud rate is none that pyserial knows.
            LinkError: the port is not there, or cannot be opened.
        """
        if not isinstance(url, str) or not url:
            raise UsageError("port", url, "the name of a serial port, or a URL")
        if not isinstance(baudrate, int) or baudrate <= 0:
            raise UsageError("baudrate", baudrate, "a whole number above 0")
        self.url = url
        try:
            self._port = serial.serial_for_url(url, do_not_open=True)
            self._port.baudrate = baudrate
        except ValueError as error:
            raise UsageError("port", url, f"what pyserial opens ({error})") from None
        # Asserted, these lines hold the controller of some boards in reset.
        self._port.dtr = False
        self._port.rts = False
        self._port.write_timeout = WRITE_TIMEOUT
        if "://" not in url:
            # Two processes on one port would mix their bytes into each other's frames.
            self._port.exclusive = True
        with self._faults(OPENING):
            self._port.open()

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""
        with self._faults("cannot be written"):
            self._port.write(data)

    def read(self, timeout: float) -> bytes:
        """What has come, as soon as there is something."""
        with self._faults("cannot be read"):
            waiting = self._port.in_waiting
            if not waiting and timeout <= 0:
                return b""
            if self._port.timeout != timeout:
                self._port.timeout = timeout
            data: bytes = self._port.read(waiting or 1)
            # The rest of what came with the first byte, without waiting for more.
            if data and not waiting and self._port.in_waiting:
                data += self._port.read(self._port.in_waiting)
            return data

    def close(self) -> None:
        """Give the port back."""
        self._port.close()

    @contextmanager
    def _faults(self, what: str) -> Iterator[None]:
        # Asked of a closed port, pyserial fails in as many ways as it has backends.
        if what != OPENING and not self._port.is_open:
            raise LinkError(self.url, f"{what}: it is closed")
        try:
            yield
        except OSError as error:
            raise LinkError(self.url, f"{what}: {_reason(error)}") from error


def _reason(error: OSError) -> str:
    if error.errno == errno.EBUSY or "exclusively lock" in str(error):
        return "another program has it open"
    return os.strerror(error.errno) if error.errno else str(error)
