"""The blocking driver: a thin loop between a link and the session."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby
from types import TracebackType
from typing import Any, ClassVar, Literal, NamedTuple, Self

from cobotwire import codec as codecs
from cobotwire.codec.interface import Noise
from cobotwire.errors import ReplyTimeout, UsageError
from cobotwire.session import Answered, Expired, HostSession, Refused, SessionEvent, Unasked
from cobotwire.table import Table
from cobotwire.transport import Transport
from cobotwire.transport.serial import SerialTransport

HEARD_LIMIT = 20


class Traffic(NamedTuple):
    """One thing that went over the line; ``time`` is ``time.monotonic()`` seconds."""

    time: float
    direction: Literal["sent", "heard"]
    data: bytes


class Driver:
    """An arm at the other end of a link; the generated clients add a method for each command.

    Every call sends its request once and never again. Calls from several threads take turns, so
    frames do not mix. A command that nothing answers returns when its bytes are written.
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
        if timeout is not None and not (isinstance(timeout, int | float) and 0 < timeout < 3600):
            raise UsageError("timeout", timeout, "seconds above 0 and below 3600")
        codec_ = codecs.load(self.table, codec)
        self._session = HostSession(codec_)
        self._timeout = timeout
        self._trace = trace
        self._lock = threading.RLock()
        self.codec = codec_.name
        self._link: Transport
        if isinstance(port, str):
            self._link = SerialTransport(port, baudrate or self.table.baudrate)
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
            self._send(name, values, text_values)

    def _ask(self, name: str, values: Sequence[Any]) -> dict[str, Any]:
        """Send a request and wait for its reply; gives the reply's fields by name."""
        with self._lock:
            self._send(name, values)
            try:
                return self._wait()
            finally:
                # Ctrl-C and a vanished link leave the session ready for the next request.
                self._session.abandon()

    def _send(
        self, name: str, values: Sequence[Any], text_values: Mapping[str, str] | None = None
    ) -> None:
        # What came since the last call is looked at first, so it cannot pass for this answer.
        while data := self._link.read(0):
            self._receive(data)
        now = time.monotonic()
        frame = self._session.request(name, values, now, self._timeout, text_values)
        try:
            self._note("sent", frame)
            self._link.write(frame)
        except BaseException:
            self._session.abandon()
            raise

    def _wait(self) -> dict[str, Any]:
        heard: list[Unasked | Noise] = []
        while True:
            for event in self._next_events():
                if isinstance(event, Answered):
                    return event.fields
                if isinstance(event, Refused):
                    raise event.error
                if isinstance(event, Expired):
                    waited = time.monotonic() - event.asked_at
                    raise ReplyTimeout(event.command.name, waited, _describe(heard))
                heard.append(event)

    def _next_events(self) -> list[SessionEvent]:
        now = time.monotonic()
        wake_at = self._session.wake_at
        assert wake_at is not None, "only asked for while a request waits"
        data = self._link.read(max(0.0, wake_at - now))
        events = self._receive(data) if data else []
        return events or self._session.wake(time.monotonic())

    def _receive(self, data: bytes) -> list[SessionEvent]:
        self._note("heard", data)
        return self._session.receive(data, time.monotonic())

    def _note(self, direction: Literal["sent", "heard"], data: bytes) -> None:
        if self._trace is not None:
            self._trace(Traffic(time.monotonic(), direction, data))


def _describe(heard: Sequence[Unasked | Noise]) -> tuple[str, ...]:
    """What was heard, a line a frame or span of noise; the last of them, if they are many."""
    lines: list[str] = []
    for noise, group in groupby(heard, key=lambda event: isinstance(event, Noise)):
        if noise:
            spans = [event for event in group if isinstance(event, Noise)]
            data = b"".join(span.data for span in spans)
            lines.append(f"noise ({spans[0].reason}) {_shown(data)}")
        else:
            frames = [event.frame for event in group if isinstance(event, Unasked)]
            lines.extend(f"frame {_shown(frame.data)}" for frame in frames)
    return tuple(lines[-HEARD_LIMIT:])


def _shown(data: bytes, limit: int = 24) -> str:
    rest = f" ... {len(data)} bytes" if len(data) > limit else ""
    return data[:limit].hex(" ").upper() + rest
