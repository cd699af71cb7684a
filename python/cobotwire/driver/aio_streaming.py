"""Streams of samples, for asyncio: :meth:`cobotwire.driver.aio.AsyncDriver.stream` makes them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from types import TracebackType
from typing import Self

from cobotwire.driver.streamed import Streamed
from cobotwire.errors import LinkError, ProtocolError, ReplyTimeout
from cobotwire.session import Question, Request
from cobotwire.session.sample import Reading, Sample, StreamReport
from cobotwire.session.sampling import Sampler

# The longest sleep, after which it is looked whether another task has closed the stream.
LOOK_SECONDS = 0.05


class AsyncStream:
    """Samples, one a turn of an ``async for`` loop; see :mod:`cobotwire.session.sampling`.

    It polls in the consumer's task, when the consumer wants a sample and not else: there is no task
    and no queue behind it. Breaking off the loop leaves nothing to be cleared up, nor does a
    cancelled task, and the stream can be gone on with. Other tasks may use the arm meanwhile.
    """

    def __init__(
        self,
        ask: Callable[[Request], Awaitable[Question]],
        queries: tuple[Streamed, ...],
        rate: float,
    ) -> None:
        self._ask = ask
        self._queries = queries
        self._sampler = Sampler(tuple(one.query for one in queries), rate)
        self._closed_at: float | None = None

    @property
    def report(self) -> StreamReport:
        """Samples, missed ones and the rate reached, until now or until it was closed."""
        now = time.monotonic() if self._closed_at is None else self._closed_at
        return self._sampler.report(now)

    def close(self) -> None:
        """End the loop and the report, from any task. Closing twice is harmless."""
        if self._closed_at is None:
            self._closed_at = time.monotonic()

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> Sample:
        """Wait for the next slot and ask; a slot without an answer is counted, and the next tried.

        Raises:
            StopAsyncIteration: the stream is closed.
            LinkError: the link is gone, and the stream closed.
            UsageError: another task waits for the next sample of this stream.
        """
        while self._closed_at is None:
            at = self._sampler.plan(time.monotonic())
            try:
                if not await self._sleep(at):
                    break
                readings = await self._readings()
            except BaseException as error:
                self._sampler.interrupted(time.monotonic())
                if isinstance(error, LinkError):
                    self.close()
                raise
            if readings is not None:
                return self._sampler.answered(readings, time.monotonic())
            self._sampler.unanswered(time.monotonic())
        raise StopAsyncIteration

    async def _sleep(self, until: float) -> bool:
        """Wait; False if the stream was closed meanwhile."""
        while (left := until - time.monotonic()) > 0 and self._closed_at is None:
            await asyncio.sleep(min(left, LOOK_SECONDS))
        return self._closed_at is None

    async def _readings(self) -> list[Reading] | None:
        """Ask every query; None as soon as one is not answered."""
        readings = []
        for one in self._queries:
            try:
                question = await self._ask(one.request)
            except (ReplyTimeout, ProtocolError):
                return None
            readings.append(one.reading(question))
        return readings

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()
