"""Lend the session to the native module, which then sends requests of streams by itself.

As long as a line has nothing else to do, a sample needs no code of Python's between its plan and
the wake-up of its consumer (``rust/py/src/stream_line.rs``). Whatever else uses the session takes
it back first. A request that is under way then goes on as any other request does.
"""

from __future__ import annotations

import time
from asyncio import Future
from collections.abc import Sequence
from typing import Any, Protocol

from cobotwire.client.aio_native_call import AsyncNativeCall
from cobotwire.client.aio_timers import LoopTimers, Timed
from cobotwire.client.traffic import TrafficListeners
from cobotwire.codec.interface import Event
from cobotwire.protocol.errors import LinkError
from cobotwire.session import Exchange, PendingRequest
from cobotwire.session.alone import Alone


class NativeSlot(Protocol):
    """Sends the requests of one stream; ``cobotwire._native.StreamSlot`` describes it."""

    def __call__(self) -> None:
        """Send what was planned, or have the session send it."""
        ...

    def plan(
        self, frame: bytes, command: str, wait: float, over: Future[Any], at: float, /
    ) -> bool:
        """Plan what the next call sends; return whether the loop has been late."""
        ...

    def forget(self) -> None:
        """Leave the next call to the session."""
        ...


class Slots(Protocol):
    """What a native slot calls: the slots of one stream."""

    def send(self) -> None:
        """Have the session send the request that is planned."""
        ...

    def resume(self, alone: Alone, requested_at: float, offset: int) -> PendingRequest:
        """Make the request known to the session, which was sent without it; return it."""
        ...


class Steps(Protocol):
    """The steps of the exchange that a native call leaves to Python."""

    lost: LinkError | None
    listeners: TrafficListeners
    timers: LoopTimers

    def turn(self) -> None:
        """Take what has come, and let time pass."""
        ...

    def sort(self, received: Sequence[Event], fed: int) -> None:
        """Take what has come; the framer had been fed ``fed`` bytes before."""
        ...

    def set_timer(self, now: float) -> None:
        """Have time pass for the session when the next thing is to be done; it is ``now``."""
        ...


class Lending:
    """Lends the session of one connection, and goes on where the native module cannot.

    Attributes:
        line: the native object that sends requests of streams.
    """

    def __init__(self, steps: Steps, exchange: Exchange, native: AsyncNativeCall) -> None:
        self._steps, self._exchange, self._native = steps, exchange, native
        self._timed = Timed(self._time_passed)
        # Takes what has come, when no request of a stream is under way.
        self.turn = steps.turn
        self.line = native.polled.stream_line(steps.listeners, self)

    def hand_over(self, slot: NativeSlot) -> None:
        """Have a thread send what a slot plans next, if there are few requests to be sent."""
        if self._steps.timers.few:
            self._native.polled.hand_over(slot)

    def slot(self, slots: Slots) -> NativeSlot:
        """Return what sends the requests of one stream."""
        return self._native.polled.stream_slot(self.line, slots)

    def lend_session(self) -> bytes | None:
        """Lend the session; return the last one-way request, empty if there is none.

        Returns:
            None if anything is under way: the session is not lent.
        """
        exchange, steps = self._exchange, self._steps
        if steps.lost is not None or self._native.polled.unwritten or not exchange.alone.is_free():
            return None
        one_way = exchange.alone.echo.one_way
        return b"" if one_way is None else one_way.frame

    def take_back(self) -> None:
        """Use the session in Python from now on; a request that is under way is known to it."""
        given = self.line.give_back()
        if given is None:
            return
        latest, waiting = given
        if latest is not None:
            self._exchange.alone.note(*latest)
        if waiting is not None:
            slots, requested_at, fed, written = waiting
            pending = slots.resume(self._exchange.alone, requested_at, fed)
            self._steps.set_timer(requested_at)
            if written < len(pending.request.frame):
                self._native.write_rest(pending, written)

    def leave_to_parent(self) -> None:
        """Let go of what a forked child has a copy of."""
        self.line.leave_to_parent()

    def received(self, events: Sequence[Event], fed: int) -> None:
        """Go on with the request under way: these events are not, or not only, its reply.

        The framer had been fed ``fed`` bytes before theirs.
        """
        self.take_back()
        self._steps.sort(events, fed)

    def watch_until(self, moment: float) -> None:
        """Let time pass for the session at a moment if a request is under way then."""
        self._steps.timers.set(self._timed, moment)

    def _time_passed(self) -> None:
        left = self.line.seconds_left()
        if left:
            self.watch_until(time.monotonic() + left)
        elif left is not None:
            self.turn()
