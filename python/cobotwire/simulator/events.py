"""Events of a simulated arm: those that behaviours emit, and the end of a motion.

Every client receives each event once.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from heapq import heappop, heappush

from cobotwire.codec.interface import Codec
from cobotwire.protocol.messages import Event
from cobotwire.protocol.table import Command, Table
from cobotwire.simulator.motion_ends import MotionEnds
from cobotwire.simulator.state import ArmState

# How often an arm checks whether another thread has emitted an event, in seconds.
POLL_SECONDS = 0.1
# Events that are kept for slow clients; a client that reads nothing loses the oldest.
KEPT = 1000


class Events:
    """The events that are planned, and those that were sent lately.

    Attributes:
        count: how many have been sent so far; a client has received those before its own count.
    """

    def __init__(
        self,
        table: Table,
        codec: Codec,
        clock: Callable[[], float],
        states: Mapping[int | None, ArmState],
    ) -> None:
        """Report motions of ``states``, which are the devices by their addresses."""
        self._ends = MotionEnds(table, codec, clock, states)
        self._has_events = any(command.event for command in table.commands)
        self._codec, self._clock = codec, clock
        # When each planned event is due, its number, and its bytes.
        self._planned: list[tuple[float, int, bytes]] = []
        self._number = 0
        self._sent: deque[bytes] = deque(maxlen=KEPT)
        self.count = 0

    def emit(self, event: Event, address: int | None, at: float) -> None:
        """Send an event of a device at a time by the arm's clock.

        Raises:
            UsageError: the edition has no such event, or does not allow its values.
        """
        values = event.values
        frame = self._codec.encode(event.command, "reply", values, address=address)
        self._number += 1
        heappush(self._planned, (at, self._number, frame))

    def watch(self, command: Command, address: int | None) -> None:
        """Note that a device has performed a command: if it moves now, the end is reported."""
        self._ends.watch(command, address)

    def forget(self) -> None:
        """Forget what is planned: the arm has restarted."""
        self._planned.clear()

    def wait(self, received: int) -> float | None:
        """Return the seconds until a client that has ``received`` events may get one more.

        None: the edition has no events.
        """
        if received < self.count:
            return 0.0
        if not self._has_events:
            return None
        waits = [POLL_SECONDS]
        if self._ends.wait is not None:
            waits.append(self._ends.wait)
        if self._planned:
            waits.append(max(0.0, self._planned[0][0] - self._clock()))
        return min(waits)

    def since(self, received: int) -> bytes:
        """Return the events that are due by now, except for the first ``received`` ones."""
        self._send_due()
        new = min(self.count - received, len(self._sent))
        return b"".join([*self._sent][len(self._sent) - new :])

    def _send_due(self) -> None:
        now = self._clock()
        while self._planned and self._planned[0][0] <= now:
            self._send(heappop(self._planned)[2])
        ended = self._ends.due()
        if ended:
            self._send(ended)

    def _send(self, frame: bytes) -> None:
        self._sent.append(frame)
        self.count += 1
