"""The blocking driver: a thin loop between a link and the session."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from types import TracebackType
from typing import Any, ClassVar, Literal, NamedTuple, Self

from cobotwire import codec as codecs
from cobotwire.errors import ReplyTimeout, UsageError
from cobotwire.session import (
    Answered,
    Expired,
    Heard,
    HostSession,
    Refused,
    Request,
    SessionEvent,
)
from cobotwire.table import Table
from cobotwire.transport import Transport, open_link

# How long a call reads what came before it, if there is no end of that.
CLEAR_SECONDS = 0.05
NOT_SENT = (
    "more than can be read; an answer to an earlier question may be among it, "
    "so this one was not sent"
)


class Traffic(NamedTuple):
    """One thing that went over the line; ``time`` is ``time.monotonic()`` seconds."""

    time: float
    direction: Literal["sent", "heard"]
    data: bytes


class Driver:
    """An arm at the other end of a link; the generated clients add a method for each command.

    Every call sends its request once and never again. Calls from several threads take turns, so
    frames do not mix. A command that nothing answers returns when its bytes are written. After a
    question was given up, the next one like it is not sent until the late answer came, or a second
    has passed since the first was sent: the two answers could not be told apart.
    """

    table: ClassVar[Table]

    def __init__(
        self,
        port: str | Transport,
        *,
        baudrate: int | None = None,
        timeout: float | None = None,
        codec: codecs.CodecName | None = None,
        trace: Callable[[Traffic], None] | None = None,
    ) -> None:
        """Open the link.

        Args:
            port: a serial port, or any URL that pyserial opens (``socket://host:port``); or an open
                transport.
            baudrate: bits a second; left out: what the edition says.
            timeout: seconds to wait for a reply; left out: what the edition says of the command.
            codec: ``native`` or ``reference``; left out: the one in use.
            trace: called with everything that goes over the line, as it goes.

        Raises:
            UsageError: an argument is not allowed.
            LinkError: the port is not there, or cannot be opened.
        """
        if timeout is not None and not _is_timeout(timeout):
            raise UsageError("timeout", timeout, "seconds above 0 and below 3600")
        codec_ = codecs.load(self.table, codec)
        self._session = HostSession(codec_)
        self._timeout = timeout
        self._trace = trace
        self._lock = threading.RLock()
        self.codec = codec_.name
        self._link: Transport
        if isinstance(port, str):
            self._link = open_link(port, self.table.baudrate if baudrate is None else baudrate)
        elif isinstance(port, Transport):
            self._link = port
        else:
            raise UsageError("port", port, "the name of a serial port, a URL, or a transport")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} on {self._link.url}, {self.codec} codec>"

    def close(self) -> None:
        """Give the link back. The arm is told nothing. Closing twice is harmless."""
        self._link.close()

    def _tell(
        self, name: str, values: Sequence[Any], text_values: Mapping[str, str] | None = None
    ) -> None:
        """Send a request that nothing answers, or whose acknowledgement is not waited for."""
        with self._lock:
            request = self._session.prepare(name, values, text_values)
            self._clear_line(request)
            self._send(request)

    def _ask(self, name: str, values: Sequence[Any]) -> dict[str, Any]:
        """Send a request and wait for its reply; gives the reply's fields by name."""
        with self._lock:
            request = self._session.prepare(name, values)
            self._clear_line(request)
            try:
                self._send(request)
                return self._wait()
            finally:
                # Ctrl-C and a vanished link leave the session ready for the next request.
                self._session.abandon()

    def _clear_line(self, request: Request) -> None:
        """Sort what has come, so that it cannot pass for this answer; wait for what is owed."""
        started = now = time.monotonic()
        while True:
            held = self._session.hold_until(request)
            data = self._link.read(0 if held is None else max(0.0, held - now))
            now = time.monotonic()
            if data:
                self._receive(data, now)
            elif held is None or now >= held:
                return
            if now < max(started, held or 0.0) + CLEAR_SECONDS:
                continue
            # A line that brings more than can be read is never clear. Orders must go out all the
            # same; but where an old answer is owed, it may lie in what has not been read.
            if held is not None:
                raise ReplyTimeout(request.command.name, now - started, (NOT_SENT,))
            return

    def _send(self, request: Request) -> None:
        frame = self._session.send(request, time.monotonic(), self._timeout)
        self._link.write(frame)
        self._note("sent", frame)

    def _wait(self) -> dict[str, Any]:
        heard = Heard()
        while True:
            for event in self._next_events():
                if isinstance(event, Answered):
                    return event.fields
                if isinstance(event, Refused):
                    raise event.error
                if isinstance(event, Expired):
                    waited = time.monotonic() - event.asked_at
                    raise ReplyTimeout(event.command.name, waited, heard.lines())
                heard.add(event)

    def _next_events(self) -> list[SessionEvent]:
        wake_at = self._session.wake_at
        assert wake_at is not None, "only asked for while a request waits"
        data = self._link.read(max(0.0, wake_at - time.monotonic()))
        now = time.monotonic()
        events = self._receive(data, now) if data else []
        # Time passes also while data keeps coming: a babbling peer does not stop the clock.
        return events + self._session.wake(now)

    def _receive(self, data: bytes, now: float) -> list[SessionEvent]:
        self._note("heard", data)
        return self._session.receive(data, now)

    def _note(self, direction: Literal["sent", "heard"], data: bytes) -> None:
        if self._trace is not None:
            self._trace(Traffic(time.monotonic(), direction, data))


def _is_timeout(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < 3600
