"""Everything that passes a connection, for traffic listeners and for the standard ``logging``."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from cobotwire.codec.interface import Noise
from cobotwire.protocol.errors import LinkError
from cobotwire.session import (
    AckReceived,
    EchoReceived,
    EventReceived,
    LateReply,
    ReplyMatched,
    ReplyRejected,
    RequestExpired,
    SessionEvent,
    Traffic,
    UnexpectedFrame,
)
from cobotwire.session.events import as_traffic

TrafficListener = Callable[[Traffic], None]

# At most this many bytes of an event are logged.
SHOWN = 64
KINDS: dict[type, str] = {
    ReplyMatched: "reply",
    AckReceived: "acknowledgement",
    EchoReceived: "echo",
    EventReceived: "event",
    UnexpectedFrame: "unexpected",
}


class TrafficListeners:
    """The traffic listeners of one connection, and its log.

    Logger ``cobotwire.traffic`` has at DEBUG every frame, both ways; at INFO what should not
    happen: noise, late and illegal replies, and silence; at WARNING a transport that is gone.
    Without listeners and log, traffic costs next to nothing.
    """

    def __init__(
        self, first: TrafficListener | None, url: str, now: Callable[[], float] = time.monotonic
    ) -> None:
        # Imported here, so that importing the package does not wait for logging.
        import logging

        # Without a handler of its own a library's warnings go to stderr.
        logging.getLogger("cobotwire").addHandler(logging.NullHandler())
        self._logger = logging.getLogger("cobotwire.traffic")
        self._debug, self._info = logging.DEBUG, logging.INFO
        self._listeners: tuple[TrafficListener, ...] = () if first is None else (first,)
        self._url = url
        self._now = now

    @property
    def silent(self) -> bool:
        """Whether frames are reported to nobody: there is no listener, and no log of frames."""
        return not self._listeners and not self._logger.isEnabledFor(self._debug)

    def add(self, listener: TrafficListener) -> Callable[[], None]:
        """Call this listener too, until the function that is returned is called."""
        self._listeners = (*self._listeners, listener)

        def remove() -> None:
            self._listeners = tuple(known for known in self._listeners if known is not listener)

        return remove

    def sent(self, align: bytes, request: bytes) -> None:
        """Report what was written: bytes that align the line, if any; and a request with its text.

        They are two events, so that listeners get a frame.
        """
        if align:
            self._sent(align)
        self._sent(request)

    def _sent(self, data: bytes) -> None:
        if self._logger.isEnabledFor(self._debug):
            self._logger.debug("%s > %s", self._url, _hex(data))
        if self._listeners:
            self._report(Traffic(self._now(), "sent", data))

    def received(self, events: Sequence[SessionEvent], now: float) -> None:
        """Report what the session made of the bytes that were read at ``now``."""
        if self._logger.isEnabledFor(self._info):
            for event in events:
                self._log(event)
        if self._listeners:
            for event in events:
                traffic = as_traffic(event, now)
                if traffic is not None:
                    self._report(traffic)

    def lost(self, error: LinkError) -> None:
        """Report that the transport is gone."""
        self._logger.warning("%s", error)

    def _report(self, traffic: Traffic) -> None:
        for listener in self._listeners:
            listener(traffic)

    def _log(self, event: SessionEvent) -> None:
        log, url = self._logger, self._url
        if isinstance(event, Noise):
            log.info("%s < noise (%s) %s", url, event.reason, _hex(event.data))
        elif isinstance(event, RequestExpired):
            log.info("%s: no reply to %s, attempts: %d", url, event.command.name, event.attempts)
        elif isinstance(event, LateReply):
            name = event.command.name
            log.info("%s < late reply to %s: %s", url, name, _hex(event.frame.data))
        elif isinstance(event, ReplyRejected):
            log.info("%s < illegal reply to %s: %s", url, event.command.name, event.error)
        elif event.frame is not None and log.isEnabledFor(self._debug):
            log.debug("%s < %s (%s)", url, _hex(event.frame.data), KINDS[type(event)])


def _hex(data: bytes) -> str:
    rest = f" ... {len(data)} bytes" if len(data) > SHOWN else ""
    return data[:SHOWN].hex(" ").upper() + rest
