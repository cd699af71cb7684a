"""Clocks for simulated arms: real time, faster time, or time that a test steps."""

from __future__ import annotations

import threading
import time
from typing import Protocol


class Clock(Protocol):
    """Seconds that only increase; calling the clock returns them."""

    @property
    def real(self) -> bool:
        """Whether its seconds are those of ``time.monotonic()``."""
        ...

    def __call__(self) -> float:
        """Return the time in seconds, from an arbitrary beginning."""
        ...

    def sleep(self, seconds: float) -> None:
        """Wait for ``seconds`` of this clock."""
        ...

    def wait(self, condition: threading.Condition, seconds: float) -> None:
        """Wait for ``seconds``, or until ``condition``, which the caller holds, is notified."""
        ...


class RunningClock:
    """The system's monotonic clock, perhaps faster: at ``rate`` 10 a minute takes 6 seconds."""

    def __init__(self, rate: float = 1.0) -> None:
        """Start now; ``rate`` of its seconds pass in one real second."""
        if not rate > 0:
            raise ValueError(f"a clock's rate must be above 0, not {rate!r}")
        self.rate = rate
        self.real = rate == 1.0
        self._began = time.monotonic()

    def __call__(self) -> float:
        """Return the time in seconds."""
        return self._began + (time.monotonic() - self._began) * self.rate

    def sleep(self, seconds: float) -> None:
        """Wait."""
        if seconds > 0:
            time.sleep(seconds / self.rate)

    def wait(self, condition: threading.Condition, seconds: float) -> None:
        """Wait for ``seconds``, or until ``condition`` is notified."""
        condition.wait(max(0.0, seconds) / self.rate)


class SteppedClock:
    """A clock that stands still until it is stepped: a test controls the time."""

    real = False

    def __init__(self, now: float = 0.0) -> None:
        self._now = now
        # If two threads step the clock, both steps count.
        self._stepping = threading.Lock()

    def __call__(self) -> float:
        """Return the sum of all steps, in seconds."""
        return self._now

    def sleep(self, seconds: float) -> None:
        """Step the clock, without waiting."""
        if seconds > 0:
            with self._stepping:
                self._now += seconds

    def wait(self, condition: threading.Condition, seconds: float) -> None:
        """Step the clock, without waiting."""
        self.sleep(seconds)
