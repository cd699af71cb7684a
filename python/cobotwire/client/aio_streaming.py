"""Streams of samples; :meth:`AsyncClient.stream` makes them."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Self

from cobotwire.client.aio_connection import AsyncConnection
from cobotwire.client.opening import Settings
from cobotwire.protocol.errors import LinkError
from cobotwire.protocol.messages import Request
from cobotwire.session.request import RequestEncoder
from cobotwire.session.sample import Sample, StreamReport
from cobotwire.session.sampling import Poll, Sampler, check_requests


class AsyncStream:
    """Samples, one for each iteration; :mod:`cobotwire.session.sampling` decides their times.

    It sends its requests in the consumer's task, and only when the consumer wants a sample: it has
    no task and no queue of its own. Leaving the loop needs no cleanup, nor does cancellation, and
    iteration can continue. Other tasks may use the arm meanwhile.
    """

    def __init__(
        self,
        connection: AsyncConnection,
        settings: Settings,
        encoder: RequestEncoder,
        requests: tuple[Request[Any], ...],
        rate: float,
    ) -> None:
        """Validate and encode the requests.

        Raises:
            UsageError: an argument is not allowed.
        """
        table = settings.codec.table
        check_requests(requests, table)
        wait, retry = settings.timeout, settings.retry
        self._polls = [
            Poll(request, encoder.encode_request(request), retry, wait) for request in requests
        ]
        self._connection = connection
        self._poller = connection.poller(lambda: self._closed_at is not None)
        self._sampler = Sampler(requests, rate)
        self._closed_at: float | None = None

    @property
    def report(self) -> StreamReport:
        """The counts of samples and missed periods, until now or until the stream was closed."""
        now = self._connection.now() if self._closed_at is None else self._closed_at
        return self._sampler.report(now)

    def close(self) -> None:
        """End the loop and the report, from any task. Closing twice is harmless."""
        if self._closed_at is None:
            self._closed_at = self._connection.now()

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> Sample:
        """Wait for the next period and sample it; a period without a sample is counted.

        Raises:
            StopAsyncIteration: the stream is closed.
            LinkError: the transport is gone, and the stream closed.
            UsageError: another task waits for the next sample of this stream.
        """
        now = self._connection.now
        while self._closed_at is None:
            at = self._sampler.plan(now())
            try:
                readings = await self._poller.readings(self._polls, at)
            except BaseException as error:
                self._sampler.interrupted(now())
                if isinstance(error, LinkError):
                    self.close()
                raise
            if readings:
                return self._sampler.answered(readings, now())
            if readings is None:
                break
            self._sampler.unanswered(now())
        raise StopAsyncIteration

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()
