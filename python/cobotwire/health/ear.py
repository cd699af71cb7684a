"""What a driver's traffic holds beside answers: noise, diagnosed; late replies; echoes."""

from __future__ import annotations

from cobotwire.codec.interface import Codec, Noise
from cobotwire.diagnose import Diagnoser, Finding, Item, Summary
from cobotwire.session import Late, Traffic


class Ear:
    """A watcher for :meth:`cobotwire.driver.Driver.watch`; small, however long it listens.

    Attributes:
        findings: the noise, counted by kind.
        noise: bytes of it.
        late: replies that came after their question was given up.
    """

    def __init__(self, codec: Codec) -> None:
        self._diagnoser = Diagnoser(codec, "reply")
        self.findings = Summary()
        self.noise = 0
        self.late = 0

    def __call__(self, traffic: Traffic) -> None:
        """Take one thing that went over the line."""
        event = traffic.event
        if event is None:
            self._diagnoser.sent(traffic.data)
        elif isinstance(event, Noise):
            self.noise += len(event.data)
            self._count(self._diagnoser.feed([event]))
        else:
            self.late += isinstance(event, Late)
            frame = getattr(event, "frame", None)
            self._count(self._diagnoser.feed([] if frame is None else [frame]))

    def pause(self) -> None:
        """Nothing comes just now: what waits for its rest is decided."""
        self._count(self._diagnoser.flush())

    def _count(self, items: list[Item]) -> None:
        for item in items:
            if isinstance(item, Finding):
                self.findings.add(item)
