"""Whatever pyserial opens: ports, ``socket://``, ``loop://``, ``rfc2217://``. Its only importer."""

from __future__ import annotations

import errno
import os
import select
import time
from contextlib import suppress
from typing import Any
from urllib.parse import urlsplit

import serial

from cobotwire.errors import LinkError, UsageError

WRITE_TIMEOUT = 1.0
READ_SIZE = 4096
# A backend that select() does not know is read in slices of this length.
SLICE_SECONDS = 0.01
HIGHEST_BAUDRATE = 2**31 - 1
CLOSED = -1
NETWORK = ("socket://", "rfc2217://")


class SerialTransport:
    """A link through pyserial; see :class:`cobotwire.transport.interface.PollableTransport`."""

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
            self._descriptor = _descriptor(self._port)
            if self._descriptor is None:
                self._port.timeout = SLICE_SECONDS
        # Each backend of pyserial fails in its own way, from KeyError to termios.error.
        except Exception as error:
            cause = _innermost(error)
            if isinstance(cause, ValueError | KeyError) and not isinstance(cause, OSError):
                raise UsageError("port", url, f"what pyserial opens ({cause})") from None
            raise LinkError(url, f"cannot be opened: {_reason(error)}") from error

    def fileno(self) -> int | None:
        """What an event loop can watch; None: this backend has nothing of the kind."""
        return None if self._closed else self._descriptor

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""
        if self._descriptor is None:
            try:
                self._port.write(data)
            except Exception as error:
                raise self._fault("cannot be written", error) from error
            return
        taken = self.write_some(data)
        if taken < len(data):
            self._write_rest(data[taken:], time.monotonic() + WRITE_TIMEOUT)

    def _write_rest(self, data: bytes, deadline: float) -> None:
        interrupt: KeyboardInterrupt | None = None
        while data:
            try:
                left = deadline - time.monotonic()
                if left <= 0:
                    raise TimeoutError(f"no byte was taken for {WRITE_TIMEOUT:.0f} s")
                select.select([], [self._descriptor or CLOSED], [], left)
                data = data[self.write_some(data) :]
            except KeyboardInterrupt as error:
                # The frame is finished first: behind half of one, the next would not be heard.
                interrupt = error
            except (OSError, ValueError, TypeError) as error:
                raise self._fault("cannot be written", error) from error
        if interrupt is not None:
            raise interrupt

    def write_some(self, data: bytes) -> int:
        """Send what is taken at once; gives how many bytes that was, perhaps 0."""
        try:
            return os.write(self._descriptor, data)  # type: ignore[arg-type]  # faults are caught
        except BlockingIOError:
            return 0
        except Exception as error:
            raise self._fault("cannot be written", error) from error

    def read(self, timeout: float) -> bytes:
        """What has come, as soon as there is something."""
        descriptor = self._descriptor
        try:
            if descriptor is None:
                return self._read_in_slices(time.monotonic() + timeout)
            # Not by pyserial's timeout: to change it configures the port anew, with every call.
            ready, _, _ = select.select([descriptor], [], [], timeout if timeout > 0 else 0)
            if not ready:
                if self._closed:
                    raise ClosedError
                return b""
            data = os.read(descriptor, READ_SIZE)
        except BlockingIOError:
            return b""
        # Asked of a port that goes away, pyserial fails in as many ways as it has backends.
        except Exception as error:
            raise self._fault("cannot be read", error) from error
        if not data:
            raise self._fault("cannot be read", OSError("the other side disconnected"))
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
        # Another file may get the number; nobody must read that one.
        self._descriptor = None if self._descriptor is None else CLOSED
        # What is gone already, or closed by another thread right now, need not be given back.
        with suppress(Exception):
            self._port.close()

    def _fault(self, what: str, error: Exception) -> LinkError:
        if isinstance(error, LinkError):
            return error
        reason = "it is closed" if self._closed else _reason(error)
        return LinkError(self.url, f"{what}: {reason}")


class ClosedError(Exception):
    """The port was closed by another thread meanwhile."""


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


def _descriptor(port: Any) -> int | None:
    """The number that select() knows the port by; None where the backend does more than to read."""
    kind = type(port)
    if kind is not serial.Serial and kind.__module__ != "serial.urlhandler.protocol_socket":
        return None
    try:
        descriptor: int = port.fileno()
        select.select([descriptor], [], [], 0)
    except (OSError, ValueError, AttributeError):
        return None
    os.set_blocking(descriptor, False)
    return descriptor


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
