"""By what clock a link goes: the system's, unless the link has one of its own."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple, Protocol, runtime_checkable


@runtime_checkable
class LinkClock(Protocol):
    """Seconds that only go forward, perhaps faster than real ones, or stepped by a test."""

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


class Times(NamedTuple):
    """What a driver goes by: the time, and how to let some pass, both in seconds."""

    now: Callable[[], float]
    sleep: Callable[[float], None]
    real: bool


SYSTEM = Times(time.monotonic, time.sleep, True)


def times_of(link: object) -> Times:
    """The times of a link: those of its attribute ``clock``, if it has one; else the system's."""
    clock = getattr(link, "clock", None)
    return Times(clock, clock.sleep, clock.real) if isinstance(clock, LinkClock) else SYSTEM
