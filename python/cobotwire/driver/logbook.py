"""Traffic in the standard ``logging``: logger ``cobotwire.line``, silent unless a program asks."""

from __future__ import annotations

import logging
from collections.abc import Sequence

from cobotwire.codec.interface import Noise
from cobotwire.errors import LinkError
from cobotwire.session import Expired, Late, Refused, SessionEvent

# So many bytes are logged of what may be kilobytes.
SHOWN = 64

# Without a handler of its own a library's warnings go to stderr.
logging.getLogger("cobotwire").addHandler(logging.NullHandler())
_log = logging.getLogger("cobotwire.line")


class Logbook:
    """The log of one line.

    DEBUG has every frame, both ways; INFO what should not be: noise, late and illegal replies, and
    silence; WARNING a link that is gone.
    """

    def __init__(self, url: str) -> None:
        self._url = url

    def sent(self, data: bytes) -> None:
        """A frame has been written."""
        if _log.isEnabledFor(logging.DEBUG):
            _log.debug("%s > %s", self._url, _shown(data))

    def heard(self, events: Sequence[SessionEvent]) -> None:
        """The session has made this of what was read."""
        if _log.isEnabledFor(logging.INFO):
            for event in events:
                self._heard(event)

    def lost(self, error: LinkError) -> None:
        """The link is gone."""
        _log.warning("%s", error)

    def _heard(self, event: SessionEvent) -> None:
        if isinstance(event, Noise):
            _log.info("%s < noise (%s) %s", self._url, event.reason, _shown(event.data))
        elif isinstance(event, Expired):
            _log.info("%s: no answer to %s, asked %d x", self._url, event.command.name, event.tries)
        elif isinstance(event, Late):
            name, data = event.command.name, _shown(event.frame.data)
            _log.info("%s < late reply to %s: %s", self._url, name, data)
        elif isinstance(event, Refused):
            _log.info("%s < illegal reply to %s: %s", self._url, event.command.name, event.error)
        elif event.frame is not None and _log.isEnabledFor(logging.DEBUG):
            kind = type(event).__name__.lower()
            _log.debug("%s < %s (%s)", self._url, _shown(event.frame.data), kind)


def _shown(data: bytes) -> str:
    rest = f" ... {len(data)} bytes" if len(data) > SHOWN else ""
    return data[:SHOWN].hex(" ").upper() + rest
