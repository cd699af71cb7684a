"""The right simulated arm behind a fault: what comes in, or what goes out, is changed."""

from __future__ import annotations

import heapq
from collections.abc import Iterable
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Event, Frame, Message
from cobotwire.errors import ProtocolError
from cobotwire.sim.arm import IDLE_SECONDS, SimulatedArm
from cobotwire.sim.clock import Clock
from cobotwire.table import Table
from mutation.device.stimulus import Stimulus, kind_of


class Said(NamedTuple):
    """Something that the device says, so many seconds after it was asked."""

    delay: float
    data: bytes


class Fault:
    """What a device does otherwise. Every hook does what is right unless a fault says else."""

    def chunk(self, data: bytes) -> None:
        """A write arrived; its frames follow."""

    def request(self, codec: Codec, asked: Message, data: bytes) -> bytes:
        """What the arm within hears instead of a legal request."""
        return data

    def reply(self, codec: Codec, asked: Message, data: bytes) -> list[Said]:
        """What the line hears instead of the answer, which may be empty."""
        return [Said(0.0, data)]

    def malformed(self, codec: Codec, kind: Stimulus, data: bytes) -> bytes:
        """What is said to bytes that are no legal request; the right arm says nothing."""
        return b""


class BrokenArm:
    """A simulated arm with a fault; a peer."""

    def __init__(self, table: Table, fault: Fault, clock: Clock) -> None:
        self._arm = SimulatedArm(table, clock=clock)
        self._codec = codecs.load(table)
        self._framer = self._codec.framer("request")
        self._fault = fault
        self._clock = clock
        self._heard_at = clock()
        self._due: list[tuple[float, int, bytes]] = []
        self._count = 0

    @property
    def wait(self) -> float | None:
        """In how many seconds :meth:`flush` must be called if nothing is heard; None: never."""
        times = [self._due[0][0]] if self._due else []
        if self._framer.pending:
            times.append(self._heard_at + IDLE_SECONDS)
        if self._arm.wait is not None:
            times.append(self._clock() + self._arm.wait)
        return max(0.0, min(times) - self._clock()) if times else None

    def receive(self, data: bytes) -> bytes:
        """Hear ``data``; gives what is said at once."""
        self._heard_at = self._clock()
        self._fault.chunk(data)
        self._sort(self._framer.feed(data))
        return self._take_due()

    def flush(self) -> bytes:
        """Time has passed; gives what is due by now."""
        if self._framer.pending and self._clock() >= self._heard_at + IDLE_SECONDS:
            self._sort(self._framer.flush())
        self._say(0.0, self._arm.flush())
        return self._take_due()

    def _sort(self, events: Iterable[Event]) -> None:
        # Noise is looked at as a whole: a broken request is refuted byte by byte.
        noise = b""
        for event in events:
            if not isinstance(event, Frame):
                noise += event.data
                continue
            self._hear_noise(noise)
            noise = b""
            self._hear(event.data)
        self._hear_noise(noise)

    def _hear_noise(self, noise: bytes) -> None:
        if noise:
            # What is refuted here is refuted for the arm within, whatever comes next.
            self._say(0.0, self._arm.receive(noise) + self._arm.flush())
            kind = kind_of(self._codec.table, noise)
            self._say(0.0, self._fault.malformed(self._codec, kind, noise))

    def _hear(self, data: bytes) -> None:
        try:
            asked = self._codec.decode("request", data)
        except ProtocolError:
            self._say(0.0, self._fault.malformed(self._codec, "illegal value", data))
            return
        heard = self._fault.request(self._codec, asked, data)
        answer = self._arm.receive(heard) if heard else b""
        for said in self._fault.reply(self._codec, asked, answer):
            self._say(said.delay, said.data)

    def _say(self, delay: float, data: bytes) -> None:
        if data:
            self._count += 1
            heapq.heappush(self._due, (self._clock() + delay, self._count, data))

    def _take_due(self) -> bytes:
        said = b""
        while self._due and self._due[0][0] <= self._clock():
            said += heapq.heappop(self._due)[2]
        return said
