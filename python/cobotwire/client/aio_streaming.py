"""Streams of samples; :meth:`AsyncClient.stream` makes them."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Self

from cobotwire.client.aio_connection import AsyncConnection
from cobotwire.client.opening import Settings
from cobotwire.protocol.errors import LinkError, ProtocolError, ReplyTimeout
from cobotwire.protocol.messages import Request
from cobotwire.session.request import RequestEncoder, result_of
from cobotwire.session.sample import Reading, Sample, StreamReport
from cobotwire.session.sampling import Sampler, check_requests

# The longest sleep, after which the stream checks whether it was closed.
CHECK_SECONDS = 0.05


class AsyncStream:
    """Samples, one for each turn of a loop; :mod:`cobotwire.session.sampling` says when.

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
        self._requests = requests
        self._encoded = [encoder.encode_request(request) for request in requests]
        self._connection = connection
        self._settings = settings
        self._sampler = Sampler(requests, rate)
        self._closed_at: float | None = None

    @property
    def report(self) -> StreamReport:
        """Samples, missed ones and the rate reached, until now or until it was closed."""
        now = self._connection.now() if self._closed_at is None else self._closed_at
        return self._sampler.report(now)

    def close(self) -> None:
        """End the loop and the report, from any task. Closing twice is harmless."""
        if self._closed_at is None:
            self._closed_at = self._connection.now()

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> Sample:
        """Wait for the next slot and sample it; a slot without a sample is counted.

        Raises:
            StopAsyncIteration: the stream is closed.
            LinkError: the transport is gone, and the stream closed.
            UsageError: another task waits for the next sample of this stream.
        """
        now = self._connection.now
        while self._closed_at is None:
            at = self._sampler.plan(now())
            try:
                if not await self._sleep(at):
                    break
                readings = await self._readings()
            except BaseException as error:
                self._sampler.interrupted(now())
                if isinstance(error, LinkError):
                    self.close()
                raise
            if readings is not None:
                return self._sampler.answered(readings, now())
            self._sampler.unanswered(now())
        raise StopAsyncIteration

    async def _sleep(self, until: float) -> bool:
        """Wait; return False if the stream was closed meanwhile."""
        now = self._connection.now
        while (left := until - now()) > 0 and self._closed_at is None:
            await self._connection.sleep(min(left, CHECK_SECONDS))
        return self._closed_at is None

    async def _readings(self) -> list[Reading[Any]] | None:
        """Send each request in turn; return None as soon as one has no legal reply."""
        _, timeout, retry = self._settings
        readings = []
        for request, encoded in zip(self._requests, self._encoded):
            try:
                done = await self._connection.request(encoded, retry, timeout)
                value = result_of(request, done.result())
            except (ReplyTimeout, ProtocolError):
                return None
            assert done.replied_at is not None, "a request without a reply has raised"
            readings.append(Reading(value, done.requested_at, done.replied_at))
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
