"""The connection to the device under test: what is sent and received, each with its time."""

from __future__ import annotations

from cobotwire.conformance.report import Direction, Exchange
from cobotwire.simulator.clock import Clock, RunningClock
from cobotwire.transport.interface import Transport


class DeviceConnection:
    """A transport and its clock. It keeps all traffic as evidence."""

    def __init__(self, transport: Transport, clock: Clock | None = None, name: str = "") -> None:
        """Start the clock of the run.

        Args:
            transport: an open transport: a port, a socket, or memory.
            clock: the clock of the transport's reads; left out: the transport's own, or real time.
            name: what reports call the device; left out: the transport's URL.
        """
        self.transport = transport
        self.name = name or transport.url
        self.clock: Clock = clock or getattr(transport, "clock", None) or RunningClock()
        self._started = self.clock()
        self._exchanges: list[Exchange] = []

    @property
    def now(self) -> float:
        """Seconds since the run began."""
        return self.clock() - self._started

    @property
    def mark(self) -> int:
        """The present position in the evidence, for :meth:`between`."""
        return len(self._exchanges)

    def between(self, first: int, last: int, most: int) -> tuple[Exchange, ...]:
        """Return the last ``most`` exchanges between two marks."""
        return tuple(self._exchanges[max(first, last - most) : last])

    def since(self, mark: int) -> list[Exchange]:
        """Return all exchanges since a mark."""
        return self._exchanges[mark:]

    def received_since(self, mark: int) -> bytes:
        """Return all bytes that were received since a mark."""
        return b"".join(each.data for each in self.since(mark) if each.direction == "received")

    def last_sent(self, most: int = 3) -> list[Exchange]:
        """Return the last requests that were sent."""
        return [each for each in self._exchanges if each.direction == "sent"][-most:]

    def send(self, data: bytes, note: str = "") -> None:
        """Send ``data``; ``note`` describes it in reports.

        Raises:
            LinkError: the connection is lost.
        """
        self._keep("sent", data, note)
        self.transport.write(data)

    def receive(self, seconds: float) -> bytes:
        """Return what comes within ``seconds``, as soon as something comes; empty if nothing does.

        Raises:
            LinkError: the connection is lost.
        """
        data = self.transport.read(max(seconds, 0.0))
        if data:
            self._keep("received", data, "")
        return data

    def _keep(self, direction: Direction, data: bytes, note: str) -> None:
        self._exchanges.append(Exchange(self.now, direction, data, note))
