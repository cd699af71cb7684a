"""A peer in memory that keeps what it receives."""

from __future__ import annotations


class SilentPeer:
    """Reply to everything with the same bytes, or with nothing."""

    wait = None

    def __init__(self, reply: bytes = b"") -> None:
        self.writes: list[bytes] = []
        self._reply = reply

    @property
    def received(self) -> bytes:
        """Everything that was received."""
        return b"".join(self.writes)

    def receive(self, data: bytes) -> bytes:
        """Keep what is received; return the reply."""
        self.writes.append(data)
        return self._reply

    def flush(self) -> bytes:
        """Return nothing: no reply is late."""
        return b""
