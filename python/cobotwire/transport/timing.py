"""The clock of a transport: the clock of the system, unless the transport has its own."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple, Protocol, runtime_checkable


@runtime_checkable
class TransportClock(Protocol):
    """Seconds that only go forward, perhaps faster than real ones, or stepped by a test."""

    @property
    def real(self) -> bool:
        """Whether its seconds are those of ``time.monotonic()``."""
        ...

    def __call__(self) -> float:
        """Return the time in seconds, from an arbitrary beginning."""
        ...

    def sleep(self, seconds: float) -> None:
        """Return when that many of this clock's seconds have passed."""
        ...


class Times(NamedTuple):
    """How a client reads the time and lets it pass, both in seconds."""

    now: Callable[[], float]
    sleep: Callable[[float], None]
    real: bool


SYSTEM = Times(time.monotonic, time.sleep, True)


def times_of(transport: object) -> Times:
    """Return the times of a transport: those of its ``clock`` if it has one, else the system's."""
    clock = getattr(transport, "clock", None)
    return Times(clock, clock.sleep, clock.real) if isinstance(clock, TransportClock) else SYSTEM
