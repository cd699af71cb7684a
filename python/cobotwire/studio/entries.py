"""What happened on a line: the entries that pages show, from traffic and from recordings."""

from __future__ import annotations

from collections import deque
from typing import Literal, NamedTuple

from cobotwire.codec.interface import Codec, Noise
from cobotwire.diagnose import Diagnoser, Finding, Item
from cobotwire.session import Traffic

Direction = Literal["sent", "received", "unknown"]
# Noise that waits for more bytes is diagnosed after this pause.
IDLE_SECONDS = 0.3


class Entry(NamedTuple):
    """A frame, a span of noise, or a remark about the line.

    Attributes:
        time: seconds since the start of the session or of the recording.
        direction: of the bytes.
        data: the bytes; empty for a remark.
        finding: what the noise is; None for a frame.
        remark: an event without bytes: an injected fault, a lost port.
        label: the kind of the remark.
    """

    time: float
    direction: Direction
    data: bytes
    finding: Finding | None = None
    remark: str = ""
    label: str = ""


class LiveEntries:
    """Turns a client's traffic into entries; its memory does not grow with the traffic."""

    def __init__(self, codec: Codec, start: float) -> None:
        """Take the time of the session's start by the client's clock."""
        self._diagnoser = Diagnoser(codec, "reply")
        self._start = start
        # The offset and the time of each frame and span of noise. Pairs before the last item that
        # the diagnoser has returned are dropped.
        self._times: deque[tuple[int, float]] = deque()
        self._received_at = start
        self._waiting = False

    def take(self, traffic: Traffic) -> list[Entry]:
        """Return the entries that one item of traffic completes."""
        if traffic.event is None:
            self._diagnoser.sent(traffic.data)
            return [Entry(traffic.time - self._start, "sent", traffic.data)]
        event = traffic.event
        part = event if isinstance(event, Noise) else getattr(event, "frame", None)
        if part is None:
            return []
        self._times.append((part.offset, traffic.time))
        self._received_at, self._waiting = traffic.time, True
        return self._entries(self._diagnoser.feed([part]))

    def idle(self, now: float) -> list[Entry]:
        """Return entries for the noise that waits for more bytes, if none have come for a while."""
        if not self._waiting or now < self._received_at + IDLE_SECONDS:
            return []
        self._waiting = False
        return self._entries(self._diagnoser.flush())

    def _entries(self, items: list[Item]) -> list[Entry]:
        found = []
        for item in items:
            while len(self._times) > 1 and self._times[1][0] <= item.offset:
                self._times.popleft()
            finding = item if isinstance(item, Finding) else None
            time = self._times[0][1] - self._start
            found.append(Entry(time, "received", item.data, finding))
        return found
