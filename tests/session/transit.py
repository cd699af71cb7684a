"""Replies in transit between an arm and the session under test, in the order of the line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar


@dataclass
class Reply:
    """A reply in transit: it starts to arrive by ``due``; ``sent`` bytes have arrived."""

    data: bytes
    due: float
    sent: int = 0

    @property
    def complete(self) -> bool:
        """Whether all bytes have arrived."""
        return self.sent == len(self.data)


R = TypeVar("R", bound=Reply)


def arrive(line: list[R], size: int, cut: bool) -> tuple[bytes, list[R]]:
    """Take up to ``size`` bytes from the line; return them, and the replies that they complete.

    With ``cut``, the rest of each reply that they touch is lost.
    """
    received, completed = b"", []
    while line and len(received) < size:
        reply = line[0]
        part = reply.data[reply.sent :][: size - len(received)]
        reply.sent += len(part)
        received += part
        completed += [reply] if reply.complete else []
        if reply.complete or cut:
            line.pop(0)
    return received, completed


def bytes_until(line: Sequence[Reply], reply: Reply) -> int:
    """Return how many bytes arrive up to the first byte of a reply: the line keeps the order."""
    before = line[: line.index(reply)]
    return sum(len(earlier.data) - earlier.sent for earlier in before) + 1
