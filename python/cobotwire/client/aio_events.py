"""Streams of events; :meth:`AsyncClient.events` makes them."""

from __future__ import annotations

from types import TracebackType
from typing import Generic, Self

from cobotwire.client.aio_connection import AsyncConnection
from cobotwire.client.events import EventQueue, EventT

# The longest wait, after which the stream checks whether it was closed.
SLICE_SECONDS = 0.05


class AsyncEventStream(Generic[EventT]):
    """Events, in the order in which they came; ``lost`` counts those that a full queue dropped.

    Events are queued from when the stream is made until it is closed.
    """

    def __init__(
        self, connection: AsyncConnection, queue: EventQueue, timeout: float | None
    ) -> None:
        self._connection = connection
        self._queue = queue
        self._timeout = timeout
        self._closed = False
        self._remove = connection.listeners.add(queue.take)

    @property
    def lost(self) -> int:
        """How many events were dropped because the queue was full; the oldest is dropped first."""
        return self._queue.lost

    def close(self) -> None:
        """End the loop, from any task. Closing twice is harmless."""
        self._closed = True
        self._remove()

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> EventT:
        """Wait for the next event.

        Raises:
            StopAsyncIteration: the stream is closed, or no event came within its timeout.
            LinkError: the transport is gone, and no event waits.
        """
        now, queue = self._connection.now, self._queue
        ends = None if self._timeout is None else now() + self._timeout
        while not self._closed:
            event: EventT | None = queue.next()
            if event is not None:
                return event
            left = SLICE_SECONDS if ends is None else ends - now()
            if left <= 0:
                break
            await self._connection.listen(min(left, SLICE_SECONDS), lambda: queue.filled)
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
