"""The correct simulated arm with a fault that changes its requests or its replies."""

from __future__ import annotations

import heapq
from collections.abc import Iterable
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, DecodedMessage, Event, Frame
from cobotwire.protocol.errors import ProtocolError
from cobotwire.protocol.table import Table
from cobotwire.simulator.arm import SimulatedArm
from cobotwire.simulator.clock import Clock
from cobotwire.simulator.peer import IDLE_SECONDS
from mutation.device.stimulus import Stimulus, kind_of


class TimedBytes(NamedTuple):
    """Bytes that the device sends, ``delay`` seconds after the request."""

    delay: float
    data: bytes


class Fault:
    """A device fault. Every hook behaves correctly unless a fault overrides it."""

    def chunk(self, data: bytes) -> None:
        """Note a write; its frames follow."""

    def request(self, codec: Codec, request: DecodedMessage, data: bytes) -> bytes:
        """Return the bytes that the inner arm receives in place of a legal request."""
        return data

    def reply(self, codec: Codec, request: DecodedMessage, data: bytes) -> list[TimedBytes]:
        """Return the bytes to send in place of the reply, which may be empty."""
        return [TimedBytes(0.0, data)]

    def malformed(self, codec: Codec, kind: Stimulus, data: bytes) -> bytes:
        """Return the reply to bytes that are not a legal request; a correct arm sends nothing."""
        return b""

    def forgets(self, kind: Stimulus) -> bytes:
        """Return a request that the arm carries out by itself after malformed input."""
        return b""


class BrokenArm:
    """A simulated arm with a fault; a peer."""

    def __init__(self, table: Table, fault: Fault, clock: Clock) -> None:
        self._arm = SimulatedArm(table, clock=clock)
        self._codec = codecs.load(table)
        self._framer = self._codec.framer("request")
        self._events = {command.id for command in table.commands if command.event}
        self._fault = fault
        self._clock = clock
        self._received_at = clock()
        self._due: list[tuple[float, int, bytes]] = []
        self._count = 0

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        times = [self._due[0][0]] if self._due else []
        if self._framer.pending:
            times.append(self._received_at + IDLE_SECONDS)
        if self._arm.wait is not None:
            times.append(self._clock() + self._arm.wait)
        return max(0.0, min(times) - self._clock()) if times else None

    def receive(self, data: bytes) -> bytes:
        """Take ``data``; return what is sent at once."""
        self._received_at = self._clock()
        self._fault.chunk(data)
        self._sort(self._framer.feed(data))
        return self._take_due()

    def flush(self) -> bytes:
        """Let time pass; return what is due by now."""
        if self._framer.pending and self._clock() >= self._received_at + IDLE_SECONDS:
            self._sort(self._framer.flush())
        self._send(0.0, self._arm.flush())
        return self._take_due()

    def _sort(self, events: Iterable[Event]) -> None:
        # Noise is judged as a whole, because a broken request is refuted byte by byte.
        noise = b""
        for event in events:
            if not isinstance(event, Frame):
                noise += event.data
                continue
            self._receive_noise(noise)
            noise = b""
            self._receive(event.data)
        self._receive_noise(noise)

    def _receive_noise(self, noise: bytes) -> None:
        if noise:
            # What is refuted here is refuted for the inner arm too, whatever comes next.
            self._send(0.0, self._arm.receive(noise) + self._arm.flush())
            kind = kind_of(self._codec.table, noise)
            self._malformed(kind, noise)

    def _receive(self, data: bytes) -> None:
        try:
            request = self._codec.decode("request", data)
        except ProtocolError:
            self._malformed("illegal value", data)
            return
        received = self._fault.request(self._codec, request, data)
        answer = self._without_events(self._arm.receive(received) if received else b"")
        for sent in self._fault.reply(self._codec, request, answer):
            self._send(sent.delay, sent.data)

    def _without_events(self, answer: bytes) -> bytes:
        """Send the events in what the inner arm sends, which no request causes; return the rest."""
        if not self._events:
            return answer
        framer = self._codec.framer("reply")
        rest = b""
        for found in (*framer.feed(answer), *framer.flush()):
            if isinstance(found, Frame) and found.command in self._events:
                self._send(0.0, found.data)
            else:
                rest += found.data
        return rest

    def _malformed(self, kind: Stimulus, data: bytes) -> None:
        self._send(0.0, self._fault.malformed(self._codec, kind, data))
        if request := self._fault.forgets(kind):
            self._arm.receive(request)

    def _send(self, delay: float, data: bytes) -> None:
        if data:
            self._count += 1
            heapq.heappush(self._due, (self._clock() + delay, self._count, data))

    def _take_due(self) -> bytes:
        sent = b""
        while self._due and self._due[0][0] <= self._clock():
            sent += heapq.heappop(self._due)[2]
        return sent
