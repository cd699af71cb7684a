"""Send the requests of a stream when its periods begin, on an event loop."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from typing import Any

from cobotwire.client.aio_steps import AsyncSteps
from cobotwire.client.aio_timers import Timed
from cobotwire.protocol.errors import ProtocolError, ReplyTimeout
from cobotwire.session import PendingRequest
from cobotwire.session.request import result_of
from cobotwire.session.sample import Reading
from cobotwire.session.sampling import Poll

# The longest sleep, after which a stream checks whether it was closed.
CHECK_SECONDS = 0.05


class AsyncPoller:
    """Sends the requests of one stream, one after another, each when its period begins.

    A timer sends the request, so the consumer's task wakes up only once: when the reply is there.
    """

    def __init__(self, opened: Callable[[], AsyncSteps], closed: Callable[[], bool]) -> None:
        """Store functions that return the connection's steps, and whether the stream is closed."""
        self._opened, self._closed = opened, closed
        self._timed = Timed(self._send)
        # The request that was sent; None: it was not sent.
        self._pending: PendingRequest | None = None

    async def readings(self, polls: Sequence[Poll], at: float) -> list[Reading[Any]] | None:
        """Send each request in turn, the first one at a given time.

        Returns:
            A reading for each request; an empty list if a request had no legal reply; None if the
            stream was closed before.

        Raises:
            LinkError: the transport is gone.
            ReplyTimeout: a simulated arm cannot reply.
        """
        self._steps = self._opened()
        readings = []
        try:
            while (left := at - time.monotonic()) > CHECK_SECONDS:
                await asyncio.sleep(min(left - CHECK_SECONDS, CHECK_SECONDS))
                if self._closed():
                    return None
            for poll in polls:
                pending = await self._answered(poll, at)
                if pending is None:
                    return None
                fields, requested_at, replied_at = pending.timed_reply()
                value = result_of(poll.request, fields)
                readings.append(Reading(value, requested_at, replied_at))
        except (ReplyTimeout, ProtocolError) as error:
            if isinstance(error, ReplyTimeout) and error.refusal:
                raise
            return []
        finally:
            self._timed.cancel()
            if self._pending is not None:
                self._steps.give_up(self._pending)
        return readings

    async def _answered(self, poll: Poll, at: float) -> PendingRequest | None:
        """Send a request at a given time, or at once if that has passed; wait until it is done.

        Returns:
            The request; None if the stream was closed before it was sent.
        """
        self._poll, self._at, self._pending = poll, at, None
        self._finished = self._steps.loop.create_future()
        if at > time.monotonic():
            self._steps.timers.set(self._timed, at)
        else:
            self._send()
        await self._finished
        return self._pending

    def _send(self) -> None:
        """Send the request, unless the stream is closed."""
        finished = self._finished
        if finished.done():
            # The consumer was cancelled, but its task has not run yet.
            return
        if self._closed():
            finished.set_result(None)
            return
        _, encoded, policy, wait = self._poll
        ends_by = time.monotonic() + self._steps.deadline
        self._pending = pending = PendingRequest(encoded, wait, policy, self._at, ends_by)
        pending.when_done(self._wake)
        try:
            self._steps.start(pending)
        except Exception as error:
            # The consumer raises it, since nobody waits for a timer.
            finished.set_exception(error)

    def _wake(self) -> None:
        if not self._finished.done():
            self._finished.set_result(None)
