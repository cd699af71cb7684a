"""What a server serves: something that answers bytes with bytes, by a clock."""

from __future__ import annotations

from typing import Protocol


class LineGone(Exception):
    """Raised by a peer that takes its line away; whoever serves it closes the line."""


class Peer(Protocol):
    """Something that answers; bytes in, bytes out. It reads its own clock."""

    @property
    def wait(self) -> float | None:
        """In how many seconds :meth:`flush` must be called if nothing is heard; None: never."""
        ...

    def receive(self, data: bytes) -> bytes:
        """Hear ``data``; gives what is to be answered at once."""
        ...

    def flush(self) -> bytes:
        """Time has passed; gives what is to be answered now."""
        ...
