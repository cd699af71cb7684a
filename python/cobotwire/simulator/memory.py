"""A transport in memory: the peer replies in this process, in real or in stepped time."""

from __future__ import annotations

import itertools
import math
import threading
from collections.abc import Callable

from cobotwire.protocol.errors import LinkError
from cobotwire.simulator.client_connection import ClientConnection
from cobotwire.simulator.clock import Clock, RunningClock
from cobotwire.simulator.peer import Peer, PeerDisconnected, SharedPeer

# Time passes even if a peer always requests an immediate flush.
TICK_SECONDS = 1e-6
_numbers = itertools.count(1)


class MemoryTransport:
    """A transport (:class:`cobotwire.transport.OpenedTransport`) that clients take like a port.

        clock = SteppedClock()
        arm = MyCobot280(MemoryTransport(SimulatedArm(TABLE, clock=clock), clock))

    The client uses the transport's ``clock``. With a ``SteppedClock`` nothing waits: reading steps
    the clock to the time when something arrives, or to the end of the wait. So a motion of ten
    seconds is over at once, and the clock has advanced by ten seconds. If several threads use the
    transport, time passes while any of them waits.

    The asyncio client waits by its event loop, which knows only real seconds: it accepts a
    transport with a ``RunningClock`` of rate 1, and rejects others with a UsageError.
    """

    kind = "memory"
    low_latency = True

    def __init__(self, peer: Peer, clock: Clock | None = None) -> None:
        """Connect to ``peer``; ``clock`` is the one that the peer uses; None: real time."""
        self.url = f"memory://{next(_numbers)}"
        self.clock: Clock = RunningClock() if clock is None else clock
        self._peer = peer
        # Held while the peer is used; notified when it has sent something, and on close().
        self._news = threading.Condition()
        self._closed = True
        self.reopen()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.url}{', closed' if self._closed else ''}>"

    def write(self, data: bytes) -> None:
        """Send all of ``data`` to the peer, which replies at once or later.

        Raises:
            LinkError: the transport is closed.
        """
        with self._news:
            self._must_be_open("cannot be written")
            # What is due by now comes before the reply to this request.
            self._with_peer(self._connection.pass_time)
            self._with_peer(self._connection.receive, data)
            self._news.notify_all()

    def write_some(self, data: bytes) -> int:
        """Send all of ``data``; return how many bytes that were."""
        self.write(data)
        return len(data)

    def read(self, timeout: float) -> bytes:
        """Return what the peer has sent; wait for it at most ``timeout`` seconds of the clock.

        The result is empty if nothing arrives in time.

        Raises:
            LinkError: the transport is closed, or another thread closes it during the read.
        """
        with self._news:
            self._must_be_open("cannot be read")
            now = self.clock()
            deadline = now + timeout
            if timeout > 0:
                # A remaining time that is too small to change the clock would let a caller read for
                # ever.
                deadline = max(deadline, math.nextafter(now, math.inf))
            while True:
                self._with_peer(self._connection.pass_time)
                if data := self._take():
                    return data
                left = deadline - self.clock()
                if left <= 0:
                    return b""
                wait = self._connection.wait
                longest = left if wait is None else min(left, max(wait, TICK_SECONDS))
                self.clock.wait(self._news, longest)
                self._must_be_open("cannot be read", "it was closed meanwhile")

    def fileno(self) -> int | None:
        """Return None: there is no descriptor to watch."""
        return None

    def close(self) -> None:
        """Close the transport; a read that waits in another thread ends at once with an error."""
        with self._news:
            self._closed = True
            self._news.notify_all()

    def reopen(self) -> None:
        """Connect again; what was not read is lost. The peer keeps its state.

        A fault scenario keeps its state too, so it may disconnect again.
        """
        with self._news:
            if isinstance(self._peer, SharedPeer):
                self._peer.forget_client()
            self._connection = ClientConnection(self._peer, self.clock)
            self._closed = False
            self._news.notify_all()

    def _with_peer(self, step: Callable[..., None], *arguments: bytes) -> None:
        try:
            step(*arguments)
        except PeerDisconnected:
            self.close()
            raise LinkError(self.url, "the peer is gone", written=None) from None

    def _take(self) -> bytes:
        return b"".join(iter(self._connection.take, b""))

    def _must_be_open(self, what: str, reason: str = "it is closed") -> None:
        if self._closed:
            raise LinkError(self.url, f"{what}: {reason}")
