"""The line and the controller behind it, as faults may change them beyond one reply."""

from __future__ import annotations

import math
from collections.abc import Callable

from cobotwire.sim.faults.exchange import Reply
from cobotwire.sim.faults.outlet import Outlet


class Line:
    """What outlasts a request: what is still to be said, and until when nobody hears.

    Times are the scenario's clock's.
    """

    def __init__(self, clock: Callable[[], float], restart: Callable[[], None]) -> None:
        self.outlet = Outlet()
        self.deaf_until = -math.inf
        self.stopped_until = -math.inf
        self.stalled_until = -math.inf
        self._clock = clock
        self._restart = restart

    @property
    def deaf(self) -> bool:
        """Whether what the host says is lost."""
        return self._clock() < self.deaf_until

    @property
    def stopped(self) -> bool:
        """Whether what the host says waits on its way."""
        return self._clock() < self.stopped_until

    def deafen(self, seconds: float = math.inf) -> None:
        """From now on nothing is heard."""
        self.deaf_until = max(self.deaf_until, self._clock() + seconds)

    def stop(self, seconds: float) -> None:
        """From now on what the host says is kept; it is heard afterwards."""
        self.stopped_until = max(self.stopped_until, self._clock() + seconds)

    def stall(self, seconds: float) -> None:
        """From now on nothing is said; it is said afterwards, in its order."""
        self.stalled_until = max(self.stalled_until, self._clock() + seconds)

    def lose_state(self) -> None:
        """The controller starts again."""
        self._restart()

    def put(self, reply: Reply, delay: float = 0.0) -> None:
        """Say a reply after a delay, but not while the arm stalls."""
        self.outlet.put(max(self._clock() + delay, self.stalled_until), reply)

    def hold(self, seconds: float, reply: Reply) -> None:
        """Keep a reply for the next one, but no longer than that."""
        self.outlet.hold(self._clock() + seconds, reply)

    def wake(self) -> None:
        """Power was off: nothing that was is left."""
        self.deaf_until = self.stopped_until = self.stalled_until = -math.inf
        self.outlet.drop()
        self._restart()
