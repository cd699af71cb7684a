"""One timer of an event loop for everything that waits for a time.

A fleet of arms needs tens of thousands of timers a second. asyncio compares its timers in Python;
here they are in one heap of numbers, and the loop waits only for the next of them. On Linux it
waits for a descriptor that becomes readable at that time, since asyncio's own timers are up to two
milliseconds late.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from contextlib import suppress
from heapq import heappop, heappush
from itertools import count
from math import inf
from weakref import WeakValueDictionary

from cobotwire.transport.alarm_clock import AlarmClock, new_alarm_clock

# The least time between two rounds of calls: SECONDS_FOR_EACH times the number of waiting calls,
# but at most LONGEST_SECONDS. So a large fleet does not wake the loop for each arm.
SECONDS_FOR_EACH, LONGEST_SECONDS = 2e-6, 1e-3


class Timed:
    """A call at a time of ``time.monotonic()``; it can be set again and again.

    Attributes:
        due: when it is called; inf: it is not set.
    """

    __slots__ = ("call", "due")

    def __init__(self, call: Callable[[], object]) -> None:
        self.call = call
        self.due = inf

    def plan(self, due: float) -> None:
        """Set the time of the call; an earlier setting no longer counts."""
        self.due = due

    def cancel(self) -> None:
        """Cancel the call, if it was not made yet."""
        self.due = inf


class LoopTimers:
    """Calls functions when they are due, in the thread of one event loop."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        # Calls by the time at which they are due; the number decides between equal times. An entry
        # whose call was cancelled, or got another time, stays until its own time.
        self._waiting: list[tuple[float, int, Timed]] = []
        self._numbers = count()
        self._wakes_at = inf
        self._handle: asyncio.TimerHandle | None = None
        self._clock = _clock_of(loop, self._run)

    def set(self, timed: Timed, due: float) -> None:
        """Set the time of a call, in place of an earlier setting. A past time means: soon."""
        timed.plan(due)
        heappush(self._waiting, (due, next(self._numbers), timed))
        if due < self._wakes_at:
            self._wake_at(due)

    def _wake_at(self, due: float) -> None:
        self._wakes_at = due
        if self._clock is not None:
            self._clock.set(None if due == inf else due)
            return
        if self._handle is not None:
            self._handle.cancel()
            self._handle = None
        if due < inf:
            self._handle = self._loop.call_later(due - time.monotonic(), self._run)

    def _run(self) -> None:
        """Make the calls that are due."""
        # The calls may set other calls, for which this function sets the timer at its end.
        self._wakes_at = -inf
        waiting, now = self._waiting, time.monotonic()
        try:
            while waiting and waiting[0][0] <= now:
                due, _, timed = heappop(waiting)
                if timed.due == due:
                    timed.cancel()
                    timed.call()
        finally:
            pause = min(SECONDS_FOR_EACH * len(waiting), LONGEST_SECONDS)
            self._wake_at(max(waiting[0][0], now + pause) if waiting else inf)


def _clock_of(loop: asyncio.AbstractEventLoop, call: Callable[[], None]) -> AlarmClock | None:
    """Return a clock that makes the loop call ``call``; None if the loop can watch no clock."""
    clock = new_alarm_clock()
    if clock is not None:
        with suppress(NotImplementedError):
            loop.add_reader(clock.fileno(), call)
            return clock
    return None


# By the id of the loop, which the timers keep alive.
_known: WeakValueDictionary[int, LoopTimers] = WeakValueDictionary()


def timers_of(loop: asyncio.AbstractEventLoop) -> LoopTimers:
    """Return the timers of a loop, which exist as long as a caller keeps them."""
    timers = _known.get(id(loop))
    if timers is None:
        timers = _known[id(loop)] = LoopTimers(loop)
    return timers
