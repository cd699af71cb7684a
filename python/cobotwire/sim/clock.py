"""Time for simulated arms: as it is, faster, or as a test says."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """Seconds that only go forward; the calling of it gives them."""

    def __call__(self) -> float:
        """The time in seconds, from an arbitrary beginning."""
        ...

    def sleep(self, seconds: float) -> None:
        """Come back when so many of this clock's seconds are over."""
        ...


class RunningClock:
    """The system's monotonic clock, perhaps faster: at ``rate`` 10 a minute takes 6 seconds."""

    def __init__(self, rate: float = 1.0) -> None:
        if not rate > 0:
            raise ValueError(f"rate: {rate!r} is not above 0")
        self.rate = rate
        self._began = time.monotonic()

    def __call__(self) -> float:
        """The seconds, of which ``rate`` go by in a second."""
        return self._began + (time.monotonic() - self._began) * self.rate

    def sleep(self, seconds: float) -> None:
        """Wait."""
        if seconds > 0:
            time.sleep(seconds / self.rate)


class SteppedClock:
    """A clock that stands until somebody steps it: a test owns the time."""

    def __init__(self, now: float = 0.0) -> None:
        self._now = now

    def __call__(self) -> float:
        """The seconds stepped so far."""
        return self._now

    def sleep(self, seconds: float) -> None:
        """Step; nobody waits."""
        if seconds > 0:
            self._now += seconds
