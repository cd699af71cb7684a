"""A peer in memory that keeps what it receives."""

from __future__ import annotations


class MemoryPeer:
    """Reply to each write with the next of the ``replies``, and then always with ``then``."""

    wait = None

    def __init__(self, *replies: bytes, then: bytes = b"") -> None:
        self.writes: list[bytes] = []
        self._replies, self._then = list(replies), then

    @property
    def received(self) -> bytes:
        """Everything that was received."""
        return b"".join(self.writes)

    def receive(self, data: bytes) -> bytes:
        """Keep what is received; return the reply."""
        self.writes.append(data)
        return self._replies.pop(0) if self._replies else self._then

    def flush(self) -> bytes:
        """Return nothing: no reply is late."""
        return b""
