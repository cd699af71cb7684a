"""The one hook through which everything passes that goes over the line; the log hangs on it too."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from cobotwire.errors import LinkError
from cobotwire.session import SessionEvent, Traffic
from cobotwire.session.traffic import heard

Watcher = Callable[[Traffic], None]


class Watchers:
    """Whoever wants to see the traffic: recordings, logs, monitors. Costs nothing without any."""

    def __init__(
        self, first: Watcher | None, url: str, now: Callable[[], float] = time.monotonic
    ) -> None:
        # Here, not above: who only imports the package need not wait for logging.
        from cobotwire.driver.logbook import Logbook

        self._watchers: tuple[Watcher, ...] = () if first is None else (first,)
        self._log = Logbook(url)
        self._now = now

    def add(self, watcher: Watcher) -> Callable[[], None]:
        """Tell this one too, until what is returned is called."""
        self._watchers = (*self._watchers, watcher)

        def end() -> None:
            self._watchers = tuple(known for known in self._watchers if known is not watcher)

        return end

    def sent(self, data: bytes) -> None:
        """A frame, with the text that follows some, has been written."""
        self._log.sent(data)
        if self._watchers:
            self._tell(Traffic(self._now(), "sent", data))

    def heard(self, events: Sequence[SessionEvent], now: float) -> None:
        """The session has made this of what was read at ``now``."""
        self._log.heard(events)
        if self._watchers:
            for event in events:
                traffic = heard(event, now)
                if traffic is not None:
                    self._tell(traffic)

    def lost(self, error: LinkError) -> None:
        """The link is gone."""
        self._log.lost(error)

    def _tell(self, traffic: Traffic) -> None:
        for watcher in self._watchers:
            watcher(traffic)
