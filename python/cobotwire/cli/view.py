"""The picture of a simulated arm as a stick figure, kept up to date in a file."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Any, Self

from cobotwire.cli.drawing import drawing
from cobotwire.editions import Edition
from cobotwire.sim import MemoryLink, RunningClock, SimulatedArm

# The arm answers at once.
ANSWER_SECONDS = 0.05


class View:
    """Draws the arm when it begins, whenever it has come to rest, and as it stands at the end.

    Drawing takes longer than a client waits, so it is done in a thread; the arm is asked in the
    loop that serves it, by a line of its own.
    """

    def __init__(self, edition: Edition, arm: SimulatedArm, clock: RunningClock, path: str) -> None:
        """Draw it once.

        Raises:
            UsageError: matplotlib or the arm's geometry is missing, or the file cannot be written.
        """
        self._draw = drawing("pose").draw_pose
        self._table, self._path = edition.TABLE, path
        link = MemoryLink(arm.another_line(lambda event, answer: None), clock)
        self._arm = edition.CLIENT(link, timeout=ANSWER_SECONDS)
        self._joints = edition.TABLE.in_role("joints").name
        self._seen = self._drawn = self._ask()
        self._worker: threading.Thread | None = None
        self._draw(self._table, self._drawn, path)

    def look(self) -> None:
        """See where it is; draw it if it has come to rest elsewhere."""
        angles = self._ask()
        busy = self._worker is not None and self._worker.is_alive()
        if angles == self._seen and angles != self._drawn and not busy:
            self._drawn = angles
            self._worker = threading.Thread(
                target=self._draw, args=(self._table, angles, self._path)
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
        if self._ask() != self._drawn:
            self._draw(self._table, self._ask(), self._path)

    def _ask(self) -> tuple[float, ...]:
        answer: Any = getattr(self._arm, self._joints)()
        return tuple(answer)
