"""Send the requests of a stream at the moments of its slots, on an event loop."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

from cobotwire.client.aio_steps import AsyncSteps
from cobotwire.client.aio_timers import Timed
from cobotwire.session import PendingRequest
from cobotwire.session.request import result_of
from cobotwire.session.sample import Reading
from cobotwire.session.sampling import Poll

# The longest sleep, after which a stream checks whether it was closed.
CHECK_SECONDS = 0.05


class AsyncSlots:
    """Sends the requests of one stream, one after another, each at its moment.

    A timer sends the request, so the consumer's task wakes up only once: when the reply is there.
    """

    def __init__(self, opened: Callable[[], AsyncSteps], closed: Callable[[], bool]) -> None:
        """Take what returns the steps of the open connection, and whether the stream is closed."""
        self._opened, self._closed = opened, closed
        self._timed = Timed(self._send)
        self._when_done = self._wake

    async def reading(self, poll: Poll, at: float) -> Reading[Any] | None:
        """Send a request at a moment; return its result, or None if the stream is closed by then.

        Raises:
            ReplyTimeout, ProtocolError: there is no legal reply.
            LinkError: the transport is gone.
        """
        steps = self._opened()
        while (left := at - time.monotonic()) > CHECK_SECONDS:
            await asyncio.sleep(min(left - CHECK_SECONDS, CHECK_SECONDS))
            if self._closed():
                return None
        request, encoded, policy, wait = poll
        self._steps = steps
        self._pending = pending = PendingRequest(encoded, wait, policy, at)
        pending.when_done(self._when_done)
        # The result is whether the request was sent.
        self._over = over = steps.loop.create_future()
        try:
            if left > 0:
                steps.timers.set(self._timed, at)
            else:
                self._send()
            if not await over:
                return None
            fields, requested_at, replied_at = pending.answer()
            return Reading(result_of(request, fields), requested_at, replied_at)
        finally:
            if not pending.done:
                self._timed.cancel()
                steps.give_up(pending)

    def _send(self) -> None:
        over = self._over
        try:
            if self._closed():
                over.set_result(False)
            else:
                self._steps.start(self._pending)
        except Exception as error:
            # The consumer raises it, since nobody waits for a timer.
            over.set_exception(error)

    def _wake(self) -> None:
        if not self._over.done():
            self._over.set_result(True)
