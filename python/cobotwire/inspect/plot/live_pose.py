"""Keep a picture of a simulated arm's pose up to date in a file."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Any, Self

from cobotwire.editions import Edition
from cobotwire.inspect.plot.pictures import draw_pose
from cobotwire.simulator import MemoryTransport, RunningClock, SimulatedArm

# A simulated arm replies at once.
REPLY_SECONDS = 0.05


class LivePose:
    """Draws the arm at the start, whenever it comes to rest in another pose, and at the end.

    Drawing takes longer than a client waits for a reply, so it runs in a thread. The arm is queried
    in the loop that serves it, over a connection of its own.
    """

    def __init__(self, edition: Edition, arm: SimulatedArm, clock: RunningClock, path: str) -> None:
        """Draw the first picture.

        Raises:
            UsageError: the picture cannot be drawn, or the file cannot be written.
        """
        self._table, self._path = arm.table, path
        transport = MemoryTransport(arm.connect(lambda event, answer: None), clock)
        self._arm = edition.CLIENT(transport, timeout=REPLY_SECONDS)
        self._joints = edition.TABLE.in_role("joints").name
        self._seen = self._drawn = self._angles()
        self._worker: threading.Thread | None = None
        draw_pose(self._table, self._drawn, path)

    def update(self) -> None:
        """Start drawing if the arm has come to rest in another pose."""
        angles = self._angles()
        busy = self._worker is not None and self._worker.is_alive()
        if angles == self._seen and angles != self._drawn and not busy:
            self._drawn = angles
            self._worker = threading.Thread(
                target=draw_pose, args=(self._table, angles, self._path)
            )
            self._worker.start()
        self._seen = angles

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._worker is not None:
            self._worker.join()
        if self._angles() != self._drawn:
            draw_pose(self._table, self._angles(), self._path)

    def _angles(self) -> tuple[float, ...]:
        angles: Any = getattr(self._arm, self._joints)()
        return tuple(angles)
