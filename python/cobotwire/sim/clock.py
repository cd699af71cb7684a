"""Time for simulated arms: as it is, faster, or as a test says."""

from __future__ import annotations

import threading
import time
from typing import Protocol


class Clock(Protocol):
    """Seconds that only go forward; the calling of it gives them."""

    @property
    def real(self) -> bool:
        """Whether its seconds are those of ``time.monotonic()``."""
        ...

    def __call__(self) -> float:
        """The time in seconds, from an arbitrary beginning."""
        ...

    def sleep(self, seconds: float) -> None:
        """Come back when so many of this clock's seconds are over."""
        ...

    def wait(self, condition: threading.Condition, seconds: float) -> None:
        """Come back when they are over, or when ``condition``, which is held, is notified."""
        ...


class RunningClock:
    """The system's monotonic clock, perhaps faster: at ``rate`` 10 a minute takes 6 seconds."""

    def __init__(self, rate: float = 1.0) -> None:
        if not rate > 0:
            raise ValueError(f"rate: {rate!r} is not above 0")
        self.rate = rate
        self.real = rate == 1.0
        self._began = time.monotonic()

    def __call__(self) -> float:
        """The seconds, of which ``rate`` go by in a second."""
        return self._began + (time.monotonic() - self._began) * self.rate

    def sleep(self, seconds: float) -> None:
        """Wait."""
        if seconds > 0:
            time.sleep(seconds / self.rate)

    def wait(self, condition: threading.Condition, seconds: float) -> None:
        """Wait, or be notified."""
        condition.wait(max(0.0, seconds) / self.rate)


class SteppedClock:
    """A clock that stands until somebody steps it: a test owns the time."""

    real = False

    def __init__(self, now: float = 0.0) -> None:
        self._now = now
        # Two threads that step it both step it.
        self._stepping = threading.Lock()

    def __call__(self) -> float:
        """The seconds stepped so far."""
        return self._now

    def sleep(self, seconds: float) -> None:
        """Step; nobody waits."""
        if seconds > 0:
            with self._stepping:
                self._now += seconds

    def wait(self, condition: threading.Condition, seconds: float) -> None:
        """Step; nobody waits, so nobody is there to notify."""
        self.sleep(seconds)
