"""An arm that was recorded: it answers what it was asked then as it did then."""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable, Iterable
from typing import NamedTuple

from cobotwire.capture import Packet
from cobotwire.codec.interface import Codec

# What stands still this long is looked up as it is.
IDLE_SECONDS = 0.2


class Heard(NamedTuple):
    """A request that came, and how many bytes it is answered with; None: it was not recorded."""

    data: bytes
    answer: int | None


class Exchange(NamedTuple):
    """Something that was sent, and each chunk that was heard until the next, so much later."""

    request: bytes
    answers: list[tuple[float, bytes]]


class ReplayedArm:
    """Answers from a capture, with the recorded delays; a peer for a pty.

    A request is looked for from where the recording stands, then from its beginning; the recording
    goes on behind it. So a program that does the same again hears the same again, and a question
    that was asked often gets its answers in their order. To a request comes all that was heard
    until the next one was sent: late replies, noise, pauses within a frame, silence.
    """

    def __init__(
        self,
        packets: Iterable[Packet],
        codec: Codec,
        *,
        speed: float = 1.0,
        clock: Callable[[], float] = time.monotonic,
        watch: Callable[[Heard], None] | None = None,
    ) -> None:
        """Read a recording.

        Args:
            packets: of one line, in any order.
            codec: whose edition cuts requests out of what comes.
            speed: 2 halves the delays.
            clock: gives the time in seconds.
            watch: called with every request.
        """
        self._exchanges = exchanges(packets)
        self._framer = codec.framer("request")
        self._speed = speed
        self._clock = clock
        self._watch = watch
        self._at = 0
        self._heard_at = 0.0
        # When, in which order, and what.
        self._due: list[tuple[float, int, bytes]] = []
        self._count = 0

    @property
    def requests(self) -> int:
        """How many requests were recorded."""
        return len(self._exchanges)

    @property
    def wait(self) -> float | None:
        """In how many seconds :meth:`flush` must be called if nothing is heard; None: never."""
        times = [self._due[0][0]] if self._due else []
        if self._framer.pending:
            times.append(self._heard_at + IDLE_SECONDS)
        return max(0.0, min(times) - self._clock()) if times else None

    def receive(self, data: bytes) -> bytes:
        """Hear ``data``; gives what was answered without delay."""
        self._heard_at = self._clock()
        for event in self._framer.feed(data):
            self._hear(event.data)
        return self._take_due()

    def flush(self) -> bytes:
        """Time has passed; gives what is due by now."""
        if self._framer.pending and self._clock() >= self._heard_at + IDLE_SECONDS:
            for event in self._framer.flush():
                self._hear(event.data)
        return self._take_due()

    def _hear(self, request: bytes) -> None:
        found = self._find(request)
        if found is not None:
            for delay, data in found.answers:
                self._count += 1
                due = self._heard_at + delay / self._speed
                heapq.heappush(self._due, (due, self._count, data))
        if self._watch is not None:
            answers = None if found is None else sum(len(data) for _, data in found.answers)
            self._watch(Heard(request, answers))

    def _find(self, request: bytes) -> Exchange | None:
        count = len(self._exchanges)
        for step in range(count):
            index = (self._at + step) % count
            if self._exchanges[index].request == request:
                self._at = index + 1
                return self._exchanges[index]
        return None

    def _take_due(self) -> bytes:
        said = b""
        while self._due and self._due[0][0] <= self._clock():
            said += heapq.heappop(self._due)[2]
        return said


def exchanges(packets: Iterable[Packet]) -> list[Exchange]:
    """What was sent, with what was heard after it. What was heard before all is nobody's answer."""
    exchanges: list[Exchange] = []
    asked_at = 0
    for time_ns, direction, data in sorted(_chunks(packets), key=lambda chunk: chunk[0]):
        if direction == "sent":
            exchanges.append(Exchange(data, []))
            asked_at = time_ns
        elif direction == "heard" and exchanges:
            exchanges[-1].answers.append(((time_ns - asked_at) / 1e9, data))
    return exchanges


def _chunks(packets: Iterable[Packet]) -> Iterable[tuple[int, str, bytes]]:
    """Requests whole, answers in the pieces in which they came."""
    for packet in packets:
        if packet.direction == "sent" or not packet.pieces:
            yield packet.time_ns, packet.direction, packet.data
            continue
        start = 0
        for size, time_ns in packet.pieces:
            yield time_ns, packet.direction, packet.data[start : start + size]
            start += size
