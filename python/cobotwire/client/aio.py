"""The asyncio client."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from copy import copy
from math import inf
from types import TracebackType
from typing import Any, ClassVar, Self

from cobotwire import codec as codecs
from cobotwire.client.aio_connection import AsyncConnection
from cobotwire.client.aio_events import AsyncEventStream
from cobotwire.client.aio_streaming import AsyncStream
from cobotwire.client.events import EventHandler, EventQueue, EventT, Wanted
from cobotwire.client.opening import (
    OnError,
    PortOpener,
    RecordPath,
    check_deadline,
    check_on_error,
    check_seconds,
    settings,
)
from cobotwire.client.traffic import TrafficListener
from cobotwire.protocol.addresses import find_address, named_address
from cobotwire.protocol.error_texts import error_text
from cobotwire.protocol.errors import CaptureError, CobotwireError, UsageError
from cobotwire.protocol.limits import Limits
from cobotwire.protocol.messages import Request, Result
from cobotwire.protocol.table import Command, Table
from cobotwire.session import Exchange, RetryPolicy, Traffic
from cobotwire.session.events import sent_command
from cobotwire.session.request import EncodedRequest, check_acknowledged
from cobotwire.transport import Transport


class AsyncClient:
    """An arm at the other end of a transport, for asyncio; see :class:`cobotwire.client.Client`.

    ``async with`` or :meth:`open` opens it, and it belongs to the event loop that runs then. Many
    tasks may share one arm. A call that is cancelled leaves it usable.
    """

    table: ClassVar[Table]

    def __init__(
        self,
        port: str | Transport,
        baudrate: int | None = None,
        *,
        timeout: float | None = None,
        deadline: float | None = None,
        retry: RetryPolicy | None = None,
        limits: Limits | None = None,
        codec: codecs.CodecName | None = None,
        trace: TrafficListener | None = None,
        record: RecordPath | None = None,
        on_error: OnError = "stop",
        address: int | str | None = None,
    ) -> None:
        """Store the arguments, which are those of the blocking client; :meth:`open` opens the port.

        Raises:
            UsageError: an argument is not allowed.
        """
        self._settings = settings(self.table, timeout, retry, codec, limits)
        self._stops = check_on_error(on_error) == "stop"
        self._stopped_for: BaseException | None = None
        self.codec = self._settings.codec.name
        self._address = find_address(self.table, address)
        self._encoder = self._settings.encoder(self._address)
        # The clients of all addresses, by the address byte; empty before the first view.
        self._views: dict[int, Self] = {}
        codec_used = self._settings.codec
        speed = self.table.baudrate if baudrate is None else baudrate
        self._baudrate = speed
        opener = PortOpener(port, speed, codec_used, record)
        exchange, longest = Exchange(codec_used), check_deadline(deadline)
        self._connection = AsyncConnection(opener, exchange, trace, longest)

    # unasync: off
    async def open(self) -> None:
        """Open the port, unless it is open.

        Raises:
            UsageError: the port or baud rate is not allowed, or the file of the recording exists.
            LinkError: the port does not exist, or cannot be opened.
        """
        await self._connection.open()

    # unasync: on
    async def close(self) -> None:
        """Close the transport. Nothing is sent to the arm. Closing twice is harmless.

        Raises:
            CaptureError: the recording is incomplete; everything is closed nevertheless.
        """
        self._connection.close()

    async def __aenter__(self) -> Self:
        await self.open()  # unasync: off
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            await self._leave(error)
        except BaseException:
            # A second Ctrl-C interrupted this. Finish it; completed steps are not repeated.
            await self._leave(error)
            raise

    async def _leave(self, error: BaseException | None) -> None:
        """Send ``stop`` if an error ended the block, and close the transport."""
        try:
            if error is not None:
                await self._stop_all_for(error)
        finally:
            await self._close_for(error)

    def __repr__(self) -> str:
        to = "" if self._address is None else f", address {self._address.name}"
        return f"<{type(self).__name__} on {self._connection.url}{to}, {self.codec} codec>"

    def at(self, address: int | str) -> Self:
        """Return this client for another address, a number or a name.

            await arm.at("left").get_angles()

        Both share the transport and the session: closing one closes the other.

        Raises:
            UsageError: the edition has no such address.
        """
        wanted = named_address(self.table, address)
        if wanted == self._address:
            return self
        if self._address is not None:
            # A stop through any of the views reaches this client's device too.
            self._views.setdefault(self._address.value, self)
        found = self._views.get(wanted.value)
        if found is None:
            found = copy(self)
            found._address = wanted
            found._encoder = self._settings.encoder(wanted)
            found = self._views.setdefault(wanted.value, found)
        return found

    def add_traffic_listener(self, listener: TrafficListener) -> Callable[[], None]:
        """Call ``listener`` with all traffic of the connection from now on, as it occurs.

        It runs on the event loop: it must be quick, and must not raise.

        Returns:
            A function that removes the listener.
        """
        return self._connection.listeners.add(listener)

    async def listen(self, seconds: float) -> None:
        """Read for some seconds, without sending; traffic listeners receive what arrives.

        Raises:
            LinkError: the transport is gone.
        """
        await self._connection.listen(seconds)

    def stream(
        self, *requests: Request[Any], rate: float, timeout: float | None = None
    ) -> AsyncStream:
        """Sample the results of queries at a rate.

            async for sample in arm.stream(GetAngles(), GetEncoder(2), rate=20):
                angles, encoder = sample[GetAngles()], sample[GetEncoder(2)]

        Requests are sent only when the loop requests a sample. A slow loop therefore misses
        samples; they are not queued or sent later, and the stream's ``report`` counts them. A
        request is not retried within its period, because the next period sends it again. After a
        request without a reply, the next identical one may have to wait: see
        ``RetryPolicy.grace``.

        Args:
            requests: messages of commands of safety class query.
            rate: samples a second, above 0 and up to 1000.
            timeout: seconds that the arm has to reply to each request; default: as in other calls.

        Returns:
            The stream. Iterating raises LinkError when the transport is gone, and nothing else.

        Raises:
            UsageError: an argument is not allowed, or is not a query; nothing was sent.
        """
        settings = self._settings.for_stream(timeout)
        return AsyncStream(self._connection, settings, self._encoder, requests, rate)

    def events(
        self, *types: type[EventT], timeout: float | None = None, capacity: int = 1000
    ) -> AsyncEventStream[EventT]:
        """Receive the messages that the device sends without a request.

            async for event in arm.events(MotionEnded, timeout=5):
                print(event.status)

        Events are queued from now on until the stream is closed, whichever call receives them.

        Args:
            types: classes of events; default: all events of the edition.
            timeout: the loop ends if no event comes for that many seconds; default: never.
            capacity: how many events the queue holds. If more wait for the loop, the oldest is
            dropped, and counted in the stream's ``lost``.

        Returns:
            The stream. Iterating raises LinkError when the transport is gone.

        Raises:
            UsageError: an argument is not allowed, or the edition has no such event.
        """
        check_seconds("timeout", timeout)
        queue = EventQueue(Wanted(self.table, types, self._address), capacity)
        return AsyncEventStream(self._connection, queue, timeout)

    def on(self, event: type[EventT], handler: Callable[[EventT], object]) -> EventHandler[EventT]:
        """Call ``handler`` with each event of a class from now on, as it comes.

        It runs on the event loop: it must be quick. An exception that it raises goes to
        ``sys.excepthook``, and to ``failures`` and ``error`` of the returned object; no call raises
        it.

        Returns:
            An object with a method ``remove``, which ends the calls.

        Raises:
            UsageError: the edition has no such event, or the handler is not a function.
        """
        made = EventHandler(Wanted(self.table, (event,), self._address), handler)
        made.start(self._connection.listeners.add)
        return made

    async def _close_for(self, error: BaseException | None) -> None:
        """Close the transport; its error does not replace the one that ended the block."""
        try:
            await self.close()
        except BaseException as failed:
            with suppress(Exception):
                # Close the rest; parts that are closed already stay closed.
                self._connection.close()
            if error is None or not isinstance(failed, Exception):
                raise
            incomplete = isinstance(failed, CaptureError)
            error.add_note(str(failed) if incomplete else f"close() raised {failed!r}")

    async def _stop_all_for(self, error: BaseException) -> None:
        """Send ``stop`` once for an error to each address that was used, and nothing after it."""
        interrupt: BaseException | None = None
        clients: list[AsyncClient] = [*self._views.values()] or [self]
        try:
            if self._stops:
                self._connection.send_only_stops()
        except BaseException as raised:
            interrupt = raised
        for client in clients:
            try:
                await client._stop_for(error)
            except BaseException as raised:
                interrupt = raised
        if interrupt is not None:
            raise interrupt

    async def _stop_for(self, error: BaseException) -> bool:
        """Send ``stop`` once for an error, unless the user chose to leave the arm alone.

        If an unexpected exception, such as Ctrl-C, interrupts this, ``stop`` is sent again. A
        second ``stop`` is harmless.

        Returns:
            Whether it was sent.
        """
        stop = self.table.find_role("stop")
        if not self._stops or stop is None or error is self._stopped_for:
            return False
        sent = True
        try:
            # A late stop is better than none, so the deadline of the client does not apply.
            await self._send(stop.request_type(), deadline=inf)
        except CobotwireError:
            # Do not raise this error: it would hide the one that ended the block.
            sent = False
        except BaseException as unexpected:
            sent = await self._stop_again(stop.request_type())
            if not isinstance(unexpected, Exception):
                raise
            error.add_note(f"stop raised {unexpected!r}; it was {'' if sent else 'not '}sent again")
        self._stopped_for = error
        return sent

    async def _stop_all(self) -> None:
        """Send ``stop`` to each address that was used, whatever ``on_error`` says.

        Raises:
            UsageError: the edition has no stop.
            LinkError: the transport is gone. Any error is raised when all addresses were tried.
        """
        stop = self.table.in_role("stop").request_type()
        clients: list[AsyncClient] = [*self._views.values()] or [self]
        error: Exception | None = None
        for client in clients:
            try:
                await client._send(stop, deadline=inf)
            except Exception as raised:
                error = error or raised
        if error is not None:
            raise error

    async def _stop_again(self, stop: Request[None]) -> bool:
        """Send ``stop`` after the first attempt was interrupted; return whether it was sent."""
        try:
            await self._send(stop)
        except Exception:
            return False
        return True

    async def _call(
        self,
        request: Request[Result],
        longest: float | None = None,
        deadline: float | None = None,
    ) -> Result:
        """Send a request, wait for its reply, and return the reply's result.

        ``longest`` limits the time for the reply, ``deadline`` that for the whole call, in seconds.
        """
        encoded = await self._encoded(request)
        wait, retry = self._settings.timeout, self._settings.retry
        if longest is not None:
            wait = self._settings.at_most(longest, encoded.command)
        done = await self._connection.request(encoded, retry, wait, deadline)
        return request.result_of(self._connection.firmware.result(done))

    async def _encoded(self, request: Request[Any]) -> EncodedRequest:
        """Validate and encode a request; check the frame that its coordinates are in.

        Raises:
            UsageError: also: the frame is not that of the limits, or the arm was stopped meanwhile.
        """
        encoded = self._encoder.encode_request(request)
        queries = self._encoder.queries_before(encoded)
        if not queries:
            return encoded
        name = encoded.command.name
        stops: list[Command] = []

        def watch(traffic: Traffic) -> None:
            command = sent_command(traffic, self._settings.codec)
            if command is not None and command.is_stop:
                stops.append(command)

        remove = self._connection.listeners.add(watch)
        try:
            for query in queries:
                if frame := await self._call(query.request_type()):
                    text = error_text("other-frame", command=name, query=query.name, frame=frame)
                    raise UsageError("limits.workspace", frame, message=text)
        finally:
            remove()
        if stops:
            message = error_text("stopped-before", command=name)
            raise UsageError("command", name, message=message)
        self._encoder.accept_frame()
        return encoded

    async def _send(
        self,
        request: Request[None],
        ack_within: float | None = None,
        deadline: float | None = None,
    ) -> None:
        """Send a one-way request at once; wait ``ack_within`` seconds for its acknowledgement.

        If ``ack_within`` is None, do not wait. ``deadline`` replaces that of the client.
        """
        if ack_within is not None:
            check_seconds("ack_within", ack_within)
        encoded = await self._encoded(request)
        if ack_within is not None:
            check_acknowledged(encoded)
        await self._connection.send(encoded, ack_within, deadline)
