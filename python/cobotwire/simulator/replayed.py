"""A recorded arm: it replies to recorded requests as it did in the recording."""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable, Iterable
from typing import NamedTuple

from cobotwire.capture import Packet
from cobotwire.codec.interface import Codec
from cobotwire.simulator.peer import IDLE_SECONDS


class ReplayedRequest(NamedTuple):
    """A request that arrived, and the size of its recorded reply; None: it was not recorded."""

    data: bytes
    reply_size: int | None


class Exchange(NamedTuple):
    """A recorded request, and what arrived until the next one.

    Attributes:
        request: the request's bytes.
        chunks: each chunk that arrived, and how many seconds after the request.
    """

    request: bytes
    chunks: list[tuple[float, bytes]]


class ReplayedArm:
    """Replies from a capture, with the recorded delays; a peer.

    A request is searched for from the present position of the recording to its end, then from its
    beginning. The position moves to the match: a program that runs again gets the same replies, and
    a repeated request gets its replies in order. The reply to a request is everything that arrived
    before the next one: late replies, noise, pauses within a frame.
    """

    def __init__(
        self,
        packets: Iterable[Packet],
        codec: Codec,
        *,
        speed: float = 1.0,
        clock: Callable[[], float] = time.monotonic,
        on_request: Callable[[ReplayedRequest], None] | None = None,
    ) -> None:
        """Read a recording.

        Args:
            packets: those of one line, in any order.
            codec: of the edition by which requests are recognised.
            speed: 2 halves the delays.
            clock: returns the time in seconds.
            on_request: called with every request.
        """
        self._exchanges = exchanges(packets)
        self._framer = codec.framer("request")
        self._speed = speed
        self._clock = clock
        self._on_request = on_request
        self._at = 0
        self._received_at = 0.0
        # The time, the order and the data of each chunk.
        self._due: list[tuple[float, int, bytes]] = []
        self._count = 0

    @property
    def requests(self) -> int:
        """The number of recorded requests."""
        return len(self._exchanges)

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        times = [self._due[0][0]] if self._due else []
        if self._framer.pending:
            times.append(self._received_at + IDLE_SECONDS)
        return max(0.0, min(times) - self._clock()) if times else None

    def receive(self, data: bytes) -> bytes:
        """Receive ``data``; return what was recorded without a delay."""
        self._received_at = self._clock()
        for event in self._framer.feed(data):
            self._handle(event.data)
        return self._take_due()

    def flush(self) -> bytes:
        """Return what is due by now."""
        if self._framer.pending and self._clock() >= self._received_at + IDLE_SECONDS:
            for event in self._framer.flush():
                self._handle(event.data)
        return self._take_due()

    def _handle(self, request: bytes) -> None:
        found = self._find(request)
        if found is not None:
            for delay, data in found.chunks:
                self._count += 1
                due = self._received_at + delay / self._speed
                heapq.heappush(self._due, (due, self._count, data))
        if self._on_request is not None:
            size = None if found is None else sum(len(data) for _, data in found.chunks)
            self._on_request(ReplayedRequest(request, size))

    def _find(self, request: bytes) -> Exchange | None:
        count = len(self._exchanges)
        for step in range(count):
            index = (self._at + step) % count
            if self._exchanges[index].request == request:
                self._at = index + 1
                return self._exchanges[index]
        return None

    def _take_due(self) -> bytes:
        due = b""
        while self._due and self._due[0][0] <= self._clock():
            due += heapq.heappop(self._due)[2]
        return due


def exchanges(packets: Iterable[Packet]) -> list[Exchange]:
    """Return each recorded request with the bytes after it. Bytes before the first are left out."""
    exchanges: list[Exchange] = []
    requested_at = 0
    for time_ns, direction, data in sorted(_chunks(packets), key=lambda chunk: chunk[0]):
        if direction == "sent":
            exchanges.append(Exchange(data, []))
            requested_at = time_ns
        elif direction == "received" and exchanges:
            exchanges[-1].chunks.append(((time_ns - requested_at) / 1e9, data))
    return exchanges


def _chunks(packets: Iterable[Packet]) -> Iterable[tuple[int, str, bytes]]:
    """Yield requests in one piece, and replies in the pieces in which they arrived."""
    for packet in packets:
        if packet.direction == "sent" or not packet.pieces:
            yield packet.time_ns, packet.direction, packet.data
            continue
        start = 0
        for size, time_ns in packet.pieces:
            yield time_ns, packet.direction, packet.data[start : start + size]
            start += size
