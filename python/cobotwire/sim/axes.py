"""Axes that move together: a straight way in their own space at constant speed."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class _Leg:
    target: tuple[float, ...]
    rate: float


class Axes:
    """Some axes, where they stand, and where they are going. Times are the owner's seconds."""

    def __init__(self, position: Sequence[float]) -> None:
        self._from = tuple(position)
        self._legs: deque[_Leg] = deque()
        self._since = 0.0
        self._paused_at: float | None = None

    def position(self, now: float) -> tuple[float, ...]:
        """Where the axes stand."""
        now = self._effective(now)
        while self._legs and now >= self._since + self._duration():
            self._since += self._duration()
            self._from = self._legs.popleft().target
        if not self._legs:
            return self._from
        share = (now - self._since) / self._duration()
        target = self._legs[0].target
        return tuple(a + (b - a) * share for a, b in zip(self._from, target))

    def target(self, now: float) -> tuple[float, ...]:
        """Where the axes will stand at the end."""
        position = self.position(now)
        return self._legs[-1].target if self._legs else position

    def moving(self, now: float) -> bool:
        """Whether there is a way left to go, paused or not."""
        self.position(now)
        return bool(self._legs)

    def go(self, target: Sequence[float], rate: float, now: float, *, queue: bool = False) -> None:
        """Move to ``target`` at ``rate`` units a second; behind the present way if ``queue``."""
        position = self.position(now)
        if not (queue and self._legs):
            self._legs.clear()
            self._from, self._since = position, self._effective(now)
        self._legs.append(_Leg(tuple(target), rate))

    def halt(self, now: float) -> None:
        """Stay where the axes stand; every way is forgotten."""
        self._from = self.position(now)
        self._legs.clear()

    def place(self, position: Sequence[float], now: float) -> None:
        """Call the present position by other numbers, as a calibration does."""
        self.halt(now)
        self._from = tuple(position)

    def pause(self, now: float) -> None:
        """Stand still, and keep the way."""
        if self._paused_at is None:
            self._paused_at = now

    def resume(self, now: float) -> None:
        """Go on with the way."""
        if self._paused_at is not None:
            self._since += now - self._paused_at
            self._paused_at = None

    def _effective(self, now: float) -> float:
        """While paused, time stands still."""
        return now if self._paused_at is None else self._paused_at

    def _duration(self) -> float:
        leg = self._legs[0]
        way = max(abs(a - b) for a, b in zip(self._from, leg.target))
        return way / leg.rate
