"""A link without a port: the peer answers in this process, in real or in stepped time."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable

from cobotwire.errors import LinkError
from cobotwire.sim.clock import Clock, RunningClock
from cobotwire.sim.line import Line
from cobotwire.sim.peer import LineGone, Peer

# A peer that wants to be woken at once, again and again, does not hold the time up.
TICK_SECONDS = 1e-6
_numbers = itertools.count(1)


class MemoryLink:
    """See :class:`cobotwire.transport.Link`; a driver takes it in place of a port.

        clock = SteppedClock()
        arm = MyCobot280(MemoryLink(SimulatedArm(TABLE, clock=clock), clock))

    The driver takes its time from the link's ``clock``. With a ``SteppedClock`` nobody waits: who
    reads steps the clock to when something comes, or to the end of the wait. So a motion of ten
    seconds is over at once, and the clock says ten seconds. Where several threads use the link, the
    time goes on while any of them waits.

    The asyncio driver waits by its event loop, which knows real seconds alone: it takes a link with
    a ``RunningClock`` of rate 1, and refuses others with a UsageError.
    """

    kind = "memory"
    low_latency = True

    def __init__(self, peer: Peer, clock: Clock | None = None) -> None:
        """Connect to ``peer``; ``clock`` is the one that the peer reads; left out: real time."""
        self.url = f"memory://{next(_numbers)}"
        self.clock: Clock = RunningClock() if clock is None else clock
        self._peer = peer
        # Held by whoever talks to the peer; notified when it has said something, and at the end.
        self._news = threading.Condition()
        self._closed = True
        self.reopen()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.url}{', closed' if self._closed else ''}>"

    def write(self, data: bytes) -> None:
        """Give all of ``data`` to the peer, which answers at once or later.

        Raises:
            LinkError: the link is closed.
        """
        with self._news:
            self._must_be_open("cannot be written")
            # What was due by now comes before the answer to what is said now.
            self._with_peer(self._line.pass_time)
            self._with_peer(self._line.hear, data)
            self._news.notify_all()

    def write_some(self, data: bytes) -> int:
        """The same; all of it is always taken."""
        self.write(data)
        return len(data)

    def read(self, timeout: float) -> bytes:
        """What the peer has said, as soon as there is something; empty after ``timeout`` seconds.

        The seconds are those of the clock.

        Raises:
            LinkError: the link is closed, perhaps meanwhile.
        """
        with self._news:
            self._must_be_open("cannot be read")
            deadline = self.clock() + timeout
            while True:
                self._with_peer(self._line.pass_time)
                if data := self._take():
                    return data
                left = deadline - self.clock()
                if left <= 0:
                    return b""
                wait = self._line.wait
                longest = left if wait is None else min(left, max(wait, TICK_SECONDS))
                self.clock.wait(self._news, longest)
                self._must_be_open("cannot be read", "it was closed meanwhile")

    def fileno(self) -> int | None:
        """None: there is no descriptor to watch."""
        return None

    def close(self) -> None:
        """Give the link back; whoever waits for it in another thread hears of it at once."""
        with self._news:
            self._closed = True
            self._news.notify_all()

    def reopen(self) -> None:
        """Connect again; what was not read is lost. The peer stays as it is.

        So does a scenario that takes the line away: it does so again when its time comes.
        """
        with self._news:
            self._line = Line(self._peer, self.clock)
            self._closed = False
            self._news.notify_all()

    def _with_peer(self, step: Callable[..., None], *arguments: bytes) -> None:
        try:
            step(*arguments)
        except LineGone:
            self.close()
            raise LinkError(self.url, "the peer is gone") from None

    def _take(self) -> bytes:
        return b"".join(iter(self._line.take, b""))

    def _must_be_open(self, what: str, reason: str = "it is closed") -> None:
        if self._closed:
            raise LinkError(self.url, f"{what}: {reason}")
