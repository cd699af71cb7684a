"""Everything that passes a connection, for traffic listeners and for the standard ``logging``."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

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
from cobotwire.transport.log import DEBUG, INFO, Log

if TYPE_CHECKING:
    from logging import Logger

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

    Attributes:
        listeners: what is called with all traffic.
    """

    def __init__(
        self, first: TrafficListener | None, url: str, now: Callable[[], float] = time.monotonic
    ) -> None:
        self._log = Log("cobotwire.traffic")
        # None as long as the program does not import ``logging``.
        self._logger = self._log.find()
        self.listeners: tuple[TrafficListener, ...] = () if first is None else (first,)
        self._url = url
        self._now = now

    def add(self, listener: TrafficListener) -> Callable[[], None]:
        """Add a listener; return a function that removes it."""
        self.listeners = (*self.listeners, listener)

        def remove() -> None:
            self.listeners = tuple(known for known in self.listeners if known is not listener)

        return remove

    def sent(self, align: bytes, request: bytes) -> None:
        """Report what was written: fill bytes, if any, and a request with its text.

        They are reported separately, so that listeners get a whole frame.
        """
        if align:
            self._sent(align)
        self._sent(request)

    def _sent(self, data: bytes) -> None:
        logger = self._logger or self._found()
        if logger is not None and logger.isEnabledFor(DEBUG):
            logger.debug("%s > %s", self._url, _hex(data))
        if self.listeners:
            self._report(Traffic(self._now(), "sent", data))

    def received(self, events: Sequence[SessionEvent], now: float) -> None:
        """Report the session's events for the bytes that were read at ``now``."""
        logger = self._logger or self._found()
        if logger is not None and logger.isEnabledFor(INFO):
            for event in events:
                self._log_event(logger, event)
        if self.listeners:
            for event in events:
                traffic = as_traffic(event, now)
                if traffic is not None:
                    self._report(traffic)

    def lost(self, error: LinkError) -> None:
        """Report that the transport is gone."""
        self._log.load().warning("%s", error)

    def _report(self, traffic: Traffic) -> None:
        for listener in self.listeners:
            listener(traffic)

    def _found(self) -> Logger | None:
        self._logger = self._log.find()
        return self._logger

    def _log_event(self, log: Logger, event: SessionEvent) -> None:
        url = self._url
        if isinstance(event, Noise):
            log.info("%s < noise (%s) %s", url, event.reason, _hex(event.data))
        elif isinstance(event, RequestExpired):
            log.info("%s: no reply to %s, attempts: %d", url, event.command.name, event.attempts)
        elif isinstance(event, LateReply):
            name = event.command.name
            log.info("%s < late reply to %s: %s", url, name, _hex(event.frame.data))
        elif isinstance(event, ReplyRejected):
            log.info("%s < illegal reply to %s: %s", url, event.command.name, event.error)
        elif event.frame is not None and log.isEnabledFor(DEBUG):
            log.debug("%s < %s (%s)", url, _hex(event.frame.data), KINDS[type(event)])


def _hex(data: bytes) -> str:
    rest = f" ... {len(data)} bytes" if len(data) > SHOWN else ""
    return data[:SHOWN].hex(" ").upper() + rest
