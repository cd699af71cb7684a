"""Transports for tests that need no arm."""

from __future__ import annotations


class RecordingTransport:
    """A transport that records what is written to it and never receives anything."""

    url = "recorder"

    def __init__(self) -> None:
        self.written = b""
        self.closed = False

    def write(self, data: bytes) -> None:
        self.written += data

    def read(self, timeout: float) -> bytes:
        return b""

    def close(self) -> None:
        self.closed = True
