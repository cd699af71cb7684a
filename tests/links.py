"""Links for tests that have no arm at the other end."""

from __future__ import annotations


class Recorder:
    """A link that keeps what is written to it; nothing ever comes back."""

    url = "recorder"

    def __init__(self) -> None:
        self.written = b""

    def write(self, data: bytes) -> None:
        self.written += data

    def read(self, timeout: float) -> bytes:
        return b""

    def close(self) -> None:
        pass
