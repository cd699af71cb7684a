"""The state of one faulty connection that outlasts a request."""

from __future__ import annotations

import math
from collections.abc import Callable

from cobotwire.simulator.faults.exchange import Reply
from cobotwire.simulator.faults.outlet import Outlet


class FaultyConnection:
    """The bytes to send, and until when the arm is deaf or stalled, or the host is stopped.

    Times are those of the scenario's clock.
    """

    def __init__(self, clock: Callable[[], float], restart: Callable[[], None]) -> None:
        """Start connected; ``restart`` makes the controller lose its state."""
        self.outlet = Outlet()
        self.deaf_until = -math.inf
        self.stopped_until = -math.inf
        self.stalled_until = -math.inf
        self.gone_from = math.inf
        self._clock = clock
        self.restart = restart

    @property
    def deaf(self) -> bool:
        """Whether what the host sends is lost."""
        return self._clock() < self.deaf_until

    @property
    def stopped(self) -> bool:
        """Whether what the host sends is held back, and arrives later."""
        return self._clock() < self.stopped_until

    def deafen(self, seconds: float = math.inf) -> None:
        """Lose what the host sends from now on."""
        self.deaf_until = max(self.deaf_until, self._clock() + seconds)

    def stop(self, seconds: float) -> None:
        """Hold back what the host sends from now on; it arrives afterwards."""
        self.stopped_until = max(self.stopped_until, self._clock() + seconds)

    def stall(self, seconds: float) -> None:
        """Hold back replies from now on; they are sent afterwards, in their order."""
        self.stalled_until = max(self.stalled_until, self._clock() + seconds)

    def disconnect(self, seconds: float) -> None:
        """Let the port disappear after a while."""
        self.gone_from = min(self.gone_from, self._clock() + seconds)

    def put(self, reply: Reply, delay: float = 0.0, number: int | None = None) -> None:
        """Send a reply after a delay, but not while the arm stalls; see :meth:`Outlet.put`."""
        self.outlet.put(max(self._clock() + delay, self.stalled_until), reply, number)

    def hold(self, seconds: float, reply: Reply, number: int | None = None) -> None:
        """Keep a reply until the next one, at most for some seconds."""
        self.outlet.hold(self._clock() + seconds, reply, number)

    def wake(self) -> None:
        """Forget everything, as after a power cycle."""
        self.deaf_until = self.stopped_until = self.stalled_until = -math.inf
        self.outlet.drop()
        self.restart()
