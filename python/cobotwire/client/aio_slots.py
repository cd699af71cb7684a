"""Send the requests of a stream at the moments of its slots, on an event loop."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from math import inf
from typing import TYPE_CHECKING, Any, Literal

from cobotwire.client.aio_steps import AsyncSteps
from cobotwire.client.aio_timers import Timed
from cobotwire.protocol.errors import ProtocolError, ReplyTimeout
from cobotwire.session import Answer, PendingRequest
from cobotwire.session.alone import Alone
from cobotwire.session.request import result_of
from cobotwire.session.sample import Reading
from cobotwire.session.sampling import Poll

if TYPE_CHECKING:
    from cobotwire.client.aio_lending import NativeSlot

# The longest sleep, after which a stream checks whether it was closed.
CHECK_SECONDS = 0.05


class AsyncSlots:
    """Sends the requests of one stream, one after another, each at its moment.

    A timer sends the request, so the consumer's task wakes up only once: when the reply is there.
    """

    def __init__(self, opened: Callable[[], AsyncSteps], closed: Callable[[], bool]) -> None:
        """Take what returns the steps of the open connection, and whether the stream is closed."""
        self._opened, self._closed = opened, closed
        self._timed = Timed(self.send)
        # Sends plain requests without the session, if there are native calls.
        self._slot: NativeSlot | None = None
        # The request as the session knows it; None: it does not.
        self._pending: PendingRequest | None = None

    def close(self) -> None:
        """Withdraw the planned request: the stream is closed."""
        if self._slot is not None:
            self._slot.forget()

    async def readings(self, polls: Sequence[Poll], at: float) -> list[Reading[Any]] | None:
        """Send each request in turn, the first one at a moment.

        Returns:
            No readings if a request had no legal reply; None if the stream was closed by then.

        Raises:
            LinkError: the transport is gone.
            ReplyTimeout: the arm, which is simulated, cannot reply.
        """
        self._steps = steps = self._opened()
        readings = []
        try:
            while (left := at - time.monotonic()) > CHECK_SECONDS:
                await asyncio.sleep(min(left - CHECK_SECONDS, CHECK_SECONDS))
                if self._closed():
                    return None
            for poll in polls:
                # Its result is the answer; or True: the session has it; None: nothing was sent.
                self._over = over = steps.loop.create_future()
                self._plan(poll, at)
                answer: Answer | Literal[True] | None = await over
                if answer is None:
                    return None
                if answer is True:
                    assert self._pending is not None, "the session sent it"
                    answer = self._pending.answer()
                fields, requested_at, replied_at = answer
                value = result_of(poll.request, fields)
                readings.append(Reading(value, requested_at, replied_at))
        except (ReplyTimeout, ProtocolError) as error:
            if isinstance(error, ReplyTimeout) and error.refusal:
                raise
            return []
        except BaseException:
            self._give_up()
            raise
        return readings

    def _plan(self, poll: Poll, at: float) -> None:
        """Have a request sent at a moment, or at once if it has passed."""
        steps, timed = self._steps, self._timed
        self._poll, self._at, self._pending = poll, at, None
        encoded, due = poll.encoded, at > time.monotonic()
        if encoded.plain and self._slot is None:
            self._slot = steps.stream_slot(self)
        slot = self._slot if encoded.plain else None
        timed.call = slot or self.send
        if slot is not None:
            wait = encoded.command.deadline_ms / 1000 if poll.wait is None else poll.wait
            wait = min(wait, steps.deadline)
            moment = at if due else inf
            name, over = encoded.command.name, self._over
            if slot.plan(encoded.frame, name, wait, over, moment) and due:
                steps.hand_over(slot)
        if due:
            steps.timers.set(timed, at)
        else:
            timed.call()

    def send(self) -> None:
        """Have the session send the request, unless the stream is closed."""
        over = self._over
        if over.done() or self._pending is not None:
            # The consumer was cancelled, and did not have its turn yet; or it was sent already.
            return
        try:
            if self._closed():
                over.set_result(None)
            else:
                self._steps.start(self._new_pending(time.monotonic()))
        except Exception as error:
            # The consumer raises it, since nobody waits for a timer.
            over.set_exception(error)

    def resume(self, alone: Alone, requested_at: float, offset: int) -> PendingRequest:
        """Make the request known to the session, which was sent without it."""
        pending = self._new_pending(requested_at)
        alone.resume_sent(pending, requested_at, offset)
        return pending

    def _new_pending(self, now: float) -> PendingRequest:
        _, encoded, policy, wait = self._poll
        ends_by = now + self._steps.deadline
        self._pending = pending = PendingRequest(encoded, wait, policy, self._at, ends_by)
        pending.when_done(self._wake)
        return pending

    def _wake(self) -> None:
        if not self._over.done():
            self._over.set_result(True)

    def _give_up(self) -> None:
        """Leave everything ready for the next request."""
        self._timed.cancel()
        steps = self._steps
        steps.take_back()
        if self._pending is not None:
            steps.give_up(self._pending)
