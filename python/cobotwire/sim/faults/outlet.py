"""What is to be said, and when. A line carries one byte after the other: replies never mix."""

from __future__ import annotations

import heapq
from collections import deque

from cobotwire.sim.faults.exchange import Piece, Reply, joined


class Outlet:
    """Replies by the time at which they are due; a pause within one holds up those behind it."""

    def __init__(self) -> None:
        # When, in which order, and what.
        self._due: list[tuple[float, int, Reply]] = []
        self._count = 0
        self._speaking: deque[Piece] = deque()
        self._said_at = 0.0
        self._held: tuple[float, Reply] | None = None

    @property
    def next(self) -> float | None:
        """When :meth:`take` has something to give; None: there is nothing."""
        times = [self._due[0][0]] if self._due else []
        if self._held is not None:
            times.append(self._held[0])
        if self._speaking:
            return self._said_at + self._speaking[0].pause
        return max(self._said_at, min(times)) if times else None

    def put(self, at: float, reply: Reply) -> None:
        """Say a reply at a time; what is held goes with it, in front and in one piece with it."""
        if not reply:
            return
        if self._held is not None:
            first = Piece(reply[0].pause, joined(self._held[1]) + reply[0].data)
            reply, self._held = (first, *reply[1:]), None
        self._push(at, reply)

    def hold(self, until: float, reply: Reply) -> None:
        """Keep a reply for the next one; if none comes until then, it is said alone."""
        self._held = (until, reply)

    @property
    def holds(self) -> bool:
        """Whether a reply is kept for the next one."""
        return self._held is not None

    def take(self, now: float) -> bytes:
        """What is due by now."""
        if self._held is not None and self._held[0] <= now:
            (at, reply), self._held = self._held, None
            self._push(at, reply)
        said = b""
        while self._begin(now) and self._said_at + self._speaking[0].pause <= now:
            piece = self._speaking.popleft()
            self._said_at += piece.pause
            said += piece.data
        return said

    def drop(self) -> int:
        """Say nothing of what is left; gives how many bytes that were."""
        left = sum(len(joined(reply)) for _, _, reply in self._due)
        left += len(joined(tuple(self._speaking)))
        left += len(joined(self._held[1])) if self._held is not None else 0
        self._due, self._held = [], None
        self._speaking.clear()
        return left

    def _push(self, at: float, reply: Reply) -> None:
        self._count += 1
        heapq.heappush(self._due, (at, self._count, reply))

    def _begin(self, now: float) -> bool:
        """Whether a reply is being said, perhaps from now on."""
        if not self._speaking and self._due and self._due[0][0] <= now:
            due, _, reply = heapq.heappop(self._due)
            self._speaking.extend(reply)
            self._said_at = max(self._said_at, due)
        return bool(self._speaking)
