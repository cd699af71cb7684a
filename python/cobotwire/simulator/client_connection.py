"""A client's connection to a peer: its unread bytes, and when the peer must be flushed."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from cobotwire.simulator.peer import Peer, SharedPeer

# Bytes of replies that wait for a client to read them. Beyond that the oldest replies are lost, as
# on a serial line without flow control.
UNREAD_LIMIT = 4096


class ClientConnection:
    """A peer and the bytes that it has sent. Its server does the waiting."""

    def __init__(self, peer: Peer, clock: Callable[[], float]) -> None:
        """Connect to a peer; ``clock`` returns the time on which the peer bases its ``wait``."""
        self._peer = peer
        self._clock = clock
        self._unread: deque[bytes] = deque()
        self._due: float | None = None

    @property
    def unread(self) -> int:
        """The number of bytes that the client has not read."""
        return sum(map(len, self._unread))

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`pass_time` has something to do; None: nothing is planned."""
        due = self._plan_flush()
        return None if due is None else max(0.0, due - self._clock())

    def receive(self, data: bytes) -> None:
        """Pass on what the client has sent."""
        self._keep(self._peer.receive(data))

    def pass_time(self) -> None:
        """Let the peer send what is due by now."""
        due = self._plan_flush()
        if due is not None and self._clock() >= due:
            self._keep(self._peer.flush())

    def forget_client(self) -> None:
        """Drop the unread replies and the incomplete request of a client that has left."""
        self._unread.clear()
        self._due = None
        if isinstance(self._peer, SharedPeer):
            self._peer.forget_client()

    def take(self) -> bytes:
        """Return the oldest reply; empty if the client has read everything."""
        return self._unread.popleft() if self._unread else b""

    def put_back(self, rest: bytes) -> None:
        """Keep the end of a reply that the client did not take."""
        if rest:
            self._unread.appendleft(rest)

    def _plan_flush(self) -> float | None:
        """Return when the peer must be flushed; a later time does not replace an earlier one."""
        wait = self._peer.wait
        if wait is None:
            self._due = None
            return None
        due = self._clock() + wait
        if self._due is None or due < self._due:
            self._due = due
        return self._due

    def _keep(self, data: bytes) -> None:
        self._due = None
        self._plan_flush()
        if not data:
            return
        self._unread.append(data)
        while len(self._unread) > 1 and self.unread > UNREAD_LIMIT:
            self._unread.popleft()
