"""A descriptor that another thread makes readable, to end a wait."""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from typing import Protocol


def new_alarm() -> Alarm:
    """Return an alarm that is not set: of one descriptor on Linux, of two elsewhere."""
    return _EventAlarm() if hasattr(os, "eventfd") else _PairAlarm()


class Alarm(Protocol):
    """A descriptor that becomes readable for good when the alarm is set."""

    descriptor: int

    def set(self) -> None:
        """Make it readable, unless it is closed."""
        ...

    def close(self) -> None:
        """Close it. Closing twice is harmless."""
        ...


class _EventAlarm:
    """An alarm of one descriptor, on Linux."""

    def __init__(self) -> None:
        # A file object, since its write() after close() fails; a bare number may be another file's.
        self._file = io.FileIO(os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC), "wb")
        self.descriptor = self._file.fileno()

    def set(self) -> None:
        # A closed file raises ValueError.
        with suppress(OSError, ValueError):
            self._file.write((1).to_bytes(8, sys.byteorder))

    def close(self) -> None:
        self._file.close()


class _PairAlarm:
    """An alarm of two sockets: every platform can wait for these, but not for a pipe."""

    def __init__(self) -> None:
        # Imported here: on Linux no serial port needs sockets.
        import socket

        self._in, self._out = socket.socketpair()
        self._out.setblocking(False)
        self.descriptor = self._in.fileno()

    def set(self) -> None:
        with suppress(OSError):
            self._out.send(b"x")

    def close(self) -> None:
        self._in.close()
        self._out.close()
