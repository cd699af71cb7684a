"""A descriptor that becomes readable at a given time, for event loops that wait for descriptors."""

from __future__ import annotations

from contextlib import suppress
from typing import Protocol

from cobotwire.transport.waiting import native_calls


class AlarmClock(Protocol):
    """A descriptor that becomes readable at a given time."""

    def fileno(self) -> int:
        """Return the descriptor, which is open as long as this object exists."""
        ...

    def set(self, due: float | None, /) -> None:
        """Make the descriptor readable from ``due`` on; None: never."""
        ...


def new_alarm_clock() -> AlarmClock | None:
    """Return a clock that is not set; None if the system has no timer with a descriptor."""
    if native_calls() is None:
        return None
    from cobotwire import _native

    # Only Linux has timer descriptors.
    with suppress(AttributeError, OSError):
        return _native.AlarmClock()
    return None
