"""The driver for asyncio: the same calls as the blocking one, over the same conversation."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, ClassVar, Self

from cobotwire import codec as codecs
from cobotwire.driver.aio_line import AsyncLine
from cobotwire.driver.opening import check_port, opened, seconds, settings
from cobotwire.driver.watching import Watcher, Watchers
from cobotwire.errors import LinkError, UsageError
from cobotwire.session import Conversation, Question, Request, RetryPolicy
from cobotwire.table import Table
from cobotwire.transport import Transport
from cobotwire.transport.timing import times_of

if TYPE_CHECKING:
    from cobotwire.driver.aio_streaming import AsyncStream
    from cobotwire.limits import Limits
    from cobotwire.session.sample import Query


class AsyncDriver:
    """An arm at the other end of a link, for asyncio; see :class:`cobotwire.driver.Driver`.

    It is opened by ``async with`` or :meth:`open`, and belongs to the loop that runs then. Many
    tasks may share one arm. A call that is cancelled leaves it usable: the reply that may still
    come is known to be late.
    """

    table: ClassVar[Table]

    def __init__(
        self,
        port: str | Transport,
        *,
        baudrate: int | None = None,
        timeout: float | None = None,
        retry: RetryPolicy | None = None,
        limits: Limits | None = None,
        codec: codecs.CodecName | None = None,
        trace: Watcher | None = None,
    ) -> None:
        """Say what to open; nothing is opened yet. The arguments are those of the blocking one.

        Raises:
            UsageError: an argument is not allowed.
        """
        check_port(port)
        if not times_of(port).real:
            allowed = "a link in real time; an event loop knows no other"
            raise UsageError("port", port, allowed)
        self._settings = settings(self.table, timeout, retry, codec, limits)
        self.codec = self._settings.codec.name
        self._port = port
        self._baudrate = baudrate
        self._conversation = Conversation(self._settings.codec)
        self._watchers = Watchers(trace, port if isinstance(port, str) else port.url)
        self._line: AsyncLine | None = None

    async def open(self) -> None:
        """Open the link, unless it is open.

        Raises:
            UsageError: the port or baud rate is not allowed.
            LinkError: the port is not there, or cannot be opened.
        """
        if self._line is not None:
            return
        # To connect may take its time: in a thread, so that the loop goes on.
        work = asyncio.get_running_loop().run_in_executor(
            None, opened, self._port, self.table, self._baudrate
        )
        try:
            link = await asyncio.shield(work)
        except asyncio.CancelledError:
            work.add_done_callback(_close_unwanted)
            raise
        self._line = AsyncLine(link, self._conversation, self._watchers)

    async def close(self) -> None:
        """Give the link back. The arm is told nothing. Closing twice is harmless."""
        if self._line is not None:
            self._line.close()

    async def __aenter__(self) -> Self:
        await self.open()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        await self.close()

    def __repr__(self) -> str:
        url = self._port if isinstance(self._port, str) else self._port.url
        return f"<{type(self).__name__} on {url}, {self.codec} codec>"

    def watch(self, watcher: Watcher) -> Callable[[], None]:
        """Call ``watcher`` with everything that goes over the line from now on, as it goes.

        It is called in the loop: it must be quick, and must not raise.

        Returns:
            What ends it, when called.
        """
        return self._watchers.add(watcher)

    def stream(self, *queries: Query, rate: float, timeout: float | None = None) -> AsyncStream:
        """Samples of what queries answer, so many times a second.

            async for sample in arm.stream("get_angles", "get_coords", rate=20):
                angles, coords = sample.values

        The arm is asked only when the loop wants a sample, so a slow loop misses samples and heaps
        up none. A sample that is missed is missed: it is counted in the stream's ``report``, and
        nothing is caught up. A question is sent once; the next slot asks again anyway. After one
        that was not answered, the next like it may have to wait: see ``RetryPolicy.grace``.

        Args:
            queries: names of commands of safety class query; with arguments as a tuple:
                ``("get_encoder", 2)``.
            rate: samples a second, above 0 and up to 1000.
            timeout: seconds that each question has; left out: as in other calls.

        Returns:
            The stream. Its loop raises LinkError when the link is gone, and nothing else.

        Raises:
            UsageError: an argument is not allowed, or is no query; nothing was sent.
        """
        # Here, not above: few programs stream, and all of them import this.
        from cobotwire.driver.aio_streaming import AsyncStream
        from cobotwire.driver.streamed import streamed

        chosen = self._settings.for_stream(timeout)

        async def ask(request: Request) -> Question:
            return await self._opened().ask(request, chosen.retry, chosen.timeout)

        asked = streamed(type(self), self.table, queries, self._conversation.prepare)
        return AsyncStream(ask, asked, rate)

    async def _tell(
        self,
        name: str,
        values: Sequence[Any],
        text_values: Mapping[str, str] | None = None,
        ack_within: float | None = None,
    ) -> None:
        """Send an order at once; wait for its acknowledgement if ``ack_within`` says how long."""
        seconds("ack_within", ack_within)
        request = self._conversation.prepare(name, values, text_values)
        await self._opened().tell(request, ack_within)

    async def _ask(
        self, name: str, values: Sequence[Any], *, longest: float | None = None
    ) -> dict[str, Any]:
        """Ask a question and wait for its reply; gives the reply's fields by name.

        ``longest`` is less than the usual seconds, where the caller has less time.
        """
        request = self._conversation.prepare(name, values)
        chosen = self._settings
        wait = chosen.timeout if longest is None else chosen.at_most(longest, request.command)
        question = await self._opened().ask(request, chosen.retry, wait)
        return question.result()

    def _opened(self) -> AsyncLine:
        if self._line is None:
            url = self._port if isinstance(self._port, str) else self._port.url
            raise LinkError(url, "it is not open: use `async with`, or await open()")
        return self._line


def _close_unwanted(work: asyncio.Future[Transport]) -> None:
    if not work.cancelled() and work.exception() is None:
        work.result().close()
