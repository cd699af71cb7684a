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
