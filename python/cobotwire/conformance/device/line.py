"""The line to the device under test: what is sent and heard, each with its time."""

from __future__ import annotations

from cobotwire.conformance.report import Direction, Exchange
from cobotwire.sim.clock import Clock, RunningClock
from cobotwire.transport.interface import Transport


class Line:
    """A link and its clock. Everything that passes is kept as evidence."""

    def __init__(self, link: Transport, clock: Clock | None = None, name: str = "") -> None:
        """Begin to listen.

        Args:
            link: an open link: a port, a socket, or a link in memory.
            clock: the one that the link's reads go by; left out: the link's own, else real time.
            name: what reports call the device; left out: the link's URL.
        """
        self.link = link
        self.name = name or link.url
        self.clock: Clock = clock or getattr(link, "clock", None) or RunningClock()
        self._began = self.clock()
        self._exchanges: list[Exchange] = []

    @property
    def now(self) -> float:
        """Seconds since the run began."""
        return self.clock() - self._began

    @property
    def mark(self) -> int:
        """A place in the evidence, for :meth:`between`."""
        return len(self._exchanges)

    def between(self, first: int, last: int, most: int) -> tuple[Exchange, ...]:
        """What passed between two marks: the last ``most`` exchanges."""
        return tuple(self._exchanges[first:last][-most:])

    def send(self, data: bytes, note: str = "") -> None:
        """Send ``data``; ``note`` says for people what it is.

        Raises:
            LinkError: the link is gone.
        """
        self._keep("sent", data, note)
        self.link.write(data)

    def hear(self, seconds: float) -> bytes:
        """What comes within ``seconds``, as soon as something comes; empty if nothing does.

        Raises:
            LinkError: the link is gone.
        """
        data = self.link.read(max(seconds, 0.0))
        if data:
            self._keep("heard", data, "")
        return data

    def _keep(self, direction: Direction, data: bytes, note: str) -> None:
        self._exchanges.append(Exchange(self.now, direction, data, note))
