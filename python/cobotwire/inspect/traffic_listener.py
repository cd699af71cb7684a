"""Count what a client receives besides the replies to its requests."""

from __future__ import annotations

from cobotwire.codec.interface import Codec, Noise
from cobotwire.diagnose import Diagnoser, Finding, Item, Summary
from cobotwire.session import LateReply, Traffic


class DiagnosingListener:
    """A traffic listener that diagnoses noise; its memory does not grow with the traffic.

    Attributes:
        findings: the findings in the noise, counted by kind.
        noise: the bytes of noise.
        sent: the number of requests that were sent, repeats included.
        late: the number of replies that came after their deadline.
    """

    def __init__(self, codec: Codec) -> None:
        self._diagnoser = Diagnoser(codec, "reply")
        self.findings = Summary()
        self.noise = 0
        self.sent = 0
        self.late = 0

    def __call__(self, traffic: Traffic) -> None:
        """Take one item of a client's traffic."""
        event = traffic.event
        if event is None:
            self.sent += 1
            self._diagnoser.sent(traffic.data)
        elif isinstance(event, Noise):
            self.noise += len(event.data)
            self._count(self._diagnoser.feed([event]))
        else:
            self.late += isinstance(event, LateReply)
            frame = getattr(event, "frame", None)
            self._count(self._diagnoser.feed([] if frame is None else [frame]))

    def flush(self) -> None:
        """Diagnose noise that waits for more bytes, because the port is idle."""
        self._count(self._diagnoser.flush())

    def _count(self, items: list[Item]) -> None:
        for item in items:
            if isinstance(item, Finding):
                self.findings.add(item)
