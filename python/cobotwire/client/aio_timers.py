"""One timer of an event loop for everything that waits for a moment.

A fleet of arms waits for tens of thousands of moments a second. asyncio compares its timers in
Python; here they are in one heap of numbers, and the loop waits only for the next of them. On Linux
it waits for a descriptor that becomes readable at that moment, since asyncio's own timers are up to
two milliseconds late.
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

# At least so many seconds pass between two rounds of calls, for each call that waits, up to the
# longest. So a large fleet does not wake the loop for each arm.
SECONDS_FOR_EACH, LONGEST_SECONDS = 2e-6, 1e-3


class Timed:
    """A call at a moment of ``time.monotonic()``; it can be set again and again.

    Attributes:
        moment: when it is called; inf: it is not.
    """

    __slots__ = ("call", "moment")

    def __init__(self, call: Callable[[], object]) -> None:
        self.call = call
        self.moment = inf

    def plan(self, moment: float) -> None:
        """Note when it is called, and at no other moment."""
        self.moment = moment

    def cancel(self) -> None:
        """Do not call it, unless it was called."""
        self.moment = inf


class LoopTimers:
    """Calls functions at their moments, in the thread of one event loop."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        # Each with its moment, and a number that decides between equal moments. What was cancelled,
        # or set to another moment, stays until then.
        self._waiting: list[tuple[float, int, Timed]] = []
        self._numbers = count()
        self._wakes_at = inf
        self._handle: asyncio.TimerHandle | None = None
        self._clock = _clock_of(loop, self._run)

    def set(self, timed: Timed, moment: float) -> None:
        """Make a call at a moment, and at no other; soon if the moment has passed."""
        timed.plan(moment)
        heappush(self._waiting, (moment, next(self._numbers), timed))
        if moment < self._wakes_at:
            self._wake_at(moment)

    def _wake_at(self, moment: float) -> None:
        self._wakes_at = moment
        if self._clock is not None:
            self._clock.set(None if moment == inf else moment)
            return
        if self._handle is not None:
            self._handle.cancel()
            self._handle = None
        if moment < inf:
            self._handle = self._loop.call_later(moment - time.monotonic(), self._run)

    def _run(self) -> None:
        """Make the calls that are due."""
        # What they set needs no timer yet.
        self._wakes_at = -inf
        waiting, now = self._waiting, time.monotonic()
        try:
            while waiting and waiting[0][0] <= now:
                moment, _, timed = heappop(waiting)
                if timed.moment == moment:
                    timed.cancel()
                    timed.call()
        finally:
            pause = min(SECONDS_FOR_EACH * len(waiting), LONGEST_SECONDS)
            self._wake_at(max(waiting[0][0], now + pause) if waiting else inf)


def _clock_of(loop: asyncio.AbstractEventLoop, call: Callable[[], None]) -> AlarmClock | None:
    """Return a clock at which the loop calls ``call``; None: there is none that it can watch."""
    clock = new_alarm_clock()
    if clock is not None:
        with suppress(NotImplementedError):
            loop.add_reader(clock.fileno(), call)
            return clock
    return None


# By the id of their loop, which they keep alive.
_known: WeakValueDictionary[int, LoopTimers] = WeakValueDictionary()


def timers_of(loop: asyncio.AbstractEventLoop) -> LoopTimers:
    """Return the timers of a loop, which exist as long as a caller keeps them."""
    timers = _known.get(id(loop))
    if timers is None:
        timers = _known[id(loop)] = LoopTimers(loop)
    return timers
