"""Measure how long the machine kept a thread from running, so that a test can repeat a run."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Self, TypeVar

R = TypeVar("R")
PERIOD = 0.005
RUNS = 4


class StallMeter:
    """A thread that wakes every 5 ms, or each ``period``, while the ``with`` block runs.

    Attributes:
        longest: the longest delay of a wake-up, in seconds.
        worst_second: the largest sum of delays within one second; shorter delays than a period are
            not counted.
        late: the time and the delay of each wake-up that was late by more than a period; empty
            unless ``listed``, since the list takes memory of the process that is measured.
    """

    def __init__(self, period: float = PERIOD, *, listed: bool = False) -> None:
        self._period = period
        self._listed = listed
        self.late: list[tuple[float, float]] = []
        self.restart()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._measure, daemon=True)

    def __enter__(self) -> Self:
        """Start to measure."""
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        """End the thread."""
        self._over.set()
        self._thread.join()

    def restart(self) -> None:
        """Forget the delays so far."""
        self.longest = self.worst_second = self._in_second = 0.0
        self._before = time.monotonic()

    def include_current(self) -> None:
        """Count the delay that has not ended yet."""
        self.longest = max(self.longest, time.monotonic() - self._before - self._period)
        self.worst_second = max(self.worst_second, self.longest)

    def _visit(self) -> None:
        """Call the subclass's measurement; its duration adds to the delay."""

    def _measure(self) -> None:
        self._before = second_from = time.monotonic()
        while not self._over.wait(self._period):
            self._visit()
            now = time.monotonic()
            too_late = now - self._before - self._period
            self.longest = max(self.longest, too_late)
            if too_late > self._period:
                self._in_second += too_late
                if self._listed:
                    self.late.append((now, too_late))
            self.worst_second = max(self.worst_second, self._in_second)
            if now - second_from > 1:
                second_from, self._in_second = now, 0.0
            self._before = now
        self.include_current()


def unstalled(
    run: Callable[[], R], allowed: float, meter: Callable[[], StallMeter] = StallMeter
) -> R:
    """Return the result of a run during which no thread waited longer than ``allowed`` seconds.

    A run during which the machine stalled is repeated, at most three times, because its times say
    nothing about the code. The result of the last run counts in any case. ``meter`` measures a run;
    one on a pseudo-terminal needs a ``PtyMeter``.
    """
    for _ in range(RUNS):
        with meter() as stalls:
            result = run()
        if stalls.longest <= allowed:
            break
    return result
