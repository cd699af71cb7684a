"""Send replies when they are due, one after another: bytes of two replies never interleave."""

from __future__ import annotations

import heapq
from collections import deque
from typing import NamedTuple

from cobotwire.simulator.faults.exchange import Piece, Reply, joined


class _Planned(NamedTuple):
    """A reply and its time. ``order`` sorts replies of the same time.

    ``numbers`` are the numbers of the requests that this reply completes.
    """

    at: float
    order: int
    reply: Reply
    numbers: tuple[int, ...]


class Outlet:
    """Sends replies when they are due; a pause within one delays those after it."""

    def __init__(self) -> None:
        self.completed: list[int] = []
        """The numbers of the requests with replies that have been sent; the owner empties it."""
        self._due: list[_Planned] = []
        self._count = 0
        self._sending: deque[Piece] = deque()
        self._numbers: tuple[int, ...] = ()
        self._sent_at = 0.0
        self._held: _Planned | None = None

    @property
    def next(self) -> float | None:
        """The time when :meth:`take` next returns bytes; None if nothing is planned."""
        times = [planned.at for planned in (*self._due[:1], self._held) if planned is not None]
        if self._sending:
            return self._sent_at + self._sending[0].pause
        return max(self._sent_at, min(times)) if times else None

    def put(self, at: float, reply: Reply, number: int | None = None) -> None:
        """Plan a reply for a time; a held reply is put before it, and both are sent as one piece.

        ``number`` is that of the request that this reply completes; None if it completes none.
        """
        if not reply:
            return
        numbers = () if number is None else (number,)
        if self._held is not None:
            first = Piece(reply[0].pause, joined(self._held.reply) + reply[0].data)
            reply, numbers = (first, *reply[1:]), (*self._held.numbers, *numbers)
            self._held = None
        self._push(at, reply, numbers)

    def hold(self, until: float, reply: Reply, number: int | None = None) -> None:
        """Hold a reply back until the next one; send it by itself if none comes by ``until``."""
        self._held = _Planned(until, 0, reply, () if number is None else (number,))

    @property
    def holds(self) -> bool:
        """Whether a reply is held back."""
        return self._held is not None

    def take(self, now: float) -> bytes:
        """Return what is due by now."""
        if self._held is not None and self._held.at <= now:
            held, self._held = self._held, None
            self._push(held.at, held.reply, held.numbers)
        sent = b""
        while self._begin(now) and self._sent_at + self._sending[0].pause <= now:
            piece = self._sending.popleft()
            self._sent_at += piece.pause
            sent += piece.data
            if not self._sending:
                self.completed += self._numbers
        return sent

    def drop(self) -> int:
        """Discard everything that is not sent yet; return its number of bytes."""
        left = sum(len(joined(planned.reply)) for planned in self._due)
        left += len(joined(tuple(self._sending)))
        left += len(joined(self._held.reply)) if self._held is not None else 0
        self._due, self._held = [], None
        self._sending.clear()
        return left

    def _push(self, at: float, reply: Reply, numbers: tuple[int, ...]) -> None:
        self._count += 1
        heapq.heappush(self._due, _Planned(at, self._count, reply, numbers))

    def _begin(self, now: float) -> bool:
        """Start the next reply if it is due; return whether a reply is being sent."""
        if not self._sending and self._due and self._due[0].at <= now:
            planned = heapq.heappop(self._due)
            self._sending.extend(planned.reply)
            self._numbers = planned.numbers
            self._sent_at = max(self._sent_at, planned.at)
        return bool(self._sending)
