"""One client's line to a peer: what was said and not read yet, and when the peer is to be woken."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from cobotwire.sim.peer import Peer

# Bytes of answers that wait for a client to read; beyond that the oldest answers are lost, as a
# serial line without flow control loses them.
UNREAD_LIMIT = 4096


class Line:
    """A peer and the bytes that it has said. It waits for nothing; whoever serves it does."""

    def __init__(self, peer: Peer, clock: Callable[[], float]) -> None:
        """``clock`` gives the seconds in which the peer's ``wait`` counts."""
        self._peer = peer
        self._clock = clock
        self._unread: deque[bytes] = deque()
        self._due: float | None = None

    @property
    def unread(self) -> int:
        """Bytes that were said and not taken."""
        return sum(map(len, self._unread))

    @property
    def wait(self) -> float | None:
        """In how many seconds :meth:`pass_time` has something to do; None: not by itself."""
        due = self._settled()
        return None if due is None else max(0.0, due - self._clock())

    def hear(self, data: bytes) -> None:
        """The client has sent ``data``."""
        self._say(self._peer.receive(data))

    def pass_time(self) -> None:
        """Let the peer say what its time has come for."""
        due = self._settled()
        if due is not None and self._clock() >= due:
            self._say(self._peer.flush())

    def take(self) -> bytes:
        """The oldest answer; empty if nothing is unread."""
        return self._unread.popleft() if self._unread else b""

    def put_back(self, rest: bytes) -> None:
        """The end of an answer that was not taken whole."""
        if rest:
            self._unread.appendleft(rest)

    def _settled(self) -> float | None:
        """When the peer is to be woken: so long after it was last heard or woken, or sooner."""
        wait = self._peer.wait
        if wait is None:
            self._due = None
            return None
        due = self._clock() + wait
        if self._due is None or due < self._due:
            self._due = due
        return self._due

    def _say(self, data: bytes) -> None:
        self._due = None
        self._settled()
        if not data:
            return
        self._unread.append(data)
        while len(self._unread) > 1 and self.unread > UNREAD_LIMIT:
            self._unread.popleft()
