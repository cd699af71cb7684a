"""Positions that move to their goals."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence


class Travel:
    """Positions that move to their goals, all at the same rate; a pause stops them."""

    _held_at: float | None

    def __init__(self, clock: Callable[[], float], start: Sequence[float]) -> None:
        self._clock = clock
        self.put(start)

    def put(self, place: Sequence[float]) -> None:
        """Set the position, at rest."""
        self._start, self.goal, self._rate = list(place), list(place), 1.0
        self._since, self._held_at = self._clock(), None

    def go(self, goal: Sequence[float], rate: float) -> None:
        """Start to move to a goal."""
        self._start, self.goal, self._rate = self.place(), list(goal), rate
        self._since, self._held_at = self._clock(), None

    def place(self) -> list[float]:
        """Return the present positions."""
        until = self._clock() if self._held_at is None else self._held_at
        most = self._rate * (until - self._since)
        return [
            b if abs(b - a) <= most else a + math.copysign(most, b - a)
            for a, b in zip(self._start, self.goal)
        ]

    def hold(self) -> None:
        """Pause the motion."""
        self._held_at = self._clock()

    def resume(self) -> None:
        """Continue the motion."""
        if self._held_at is not None:
            self.go(self.goal, self._rate)

    @property
    def ends_at(self) -> float:
        """The time at which all positions reach their goals, if nothing pauses them."""
        way = max(abs(b - a) for a, b in zip(self._start, self.goal))
        return self._since + way / self._rate

    @property
    def moves(self) -> bool:
        """Whether any position is changing."""
        return self._held_at is None and self.place() != self.goal

    @property
    def held(self) -> bool:
        """Whether the motion is paused."""
        return self._held_at is not None
