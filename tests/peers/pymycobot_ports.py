"""Ports for pymycobot and transports for our client that need no arm."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn


class Written(Exception):
    """Raised by a port at its first write, so that the call neither waits nor writes again."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        super().__init__(data.hex(" "))


class RecordingPort:
    """The part of ``serial.Serial`` that pymycobot uses until it has written a request."""

    is_open = True

    def isOpen(self) -> bool:
        return True

    def reset_input_buffer(self) -> None:
        """Do nothing: no input ever arrives."""

    def write(self, data: Sequence[int]) -> NoReturn:
        raise Written(bytes(data))


class RecordingTransport:
    """A transport for our client that raises its first write as an exception."""

    url = "recording"

    def write(self, data: bytes) -> None:
        raise Written(data)

    def read(self, timeout: float) -> bytes:
        return b""

    def close(self) -> None:
        """Do nothing: there is nothing to release."""


class ReplyingPort:
    """The part of ``serial.Serial`` that pymycobot uses; every write gets the same reply."""

    is_open = True

    def __init__(self, reply: bytes = b"") -> None:
        self.written = b""
        self._reply = reply
        self._waiting = b""

    def isOpen(self) -> bool:
        return True

    def reset_input_buffer(self) -> None:
        self._waiting = b""

    def write(self, data: Sequence[int]) -> None:
        self.written += bytes(data)
        self._waiting += self._reply

    def inWaiting(self) -> int:
        return len(self._waiting)

    def read(self, size: int = 1) -> bytes:
        data, self._waiting = self._waiting[:size], self._waiting[size:]
        return data
