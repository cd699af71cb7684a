"""The arm of the campaign: it numbers its replies, and records what it received and sent."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from attack.calls import reply_values
from cobotwire.codec.interface import Codec, Event
from cobotwire.session.device import DeviceSession, RequestReceived
from cobotwire.simulator.faults import Fault
from cobotwire.simulator.faults.chooser import choosers
from cobotwire.simulator.faults.exchange import Reply, joined
from cobotwire.simulator.faults.faulty import Chosen, FaultyPeer
from cobotwire.simulator.faults.outlet import Outlet


class Made(NamedTuple):
    """A reply that the arm made.

    Attributes:
        frame: its bytes, before any fault.
        request: the request that it answers, as the arm received it.
        at: when the request arrived.
        damaged: whether the line had changed the request.
        value: the result of a call that gets this reply; None: it is an acknowledgement.
    """

    frame: bytes
    request: bytes
    at: float
    damaged: bool
    value: Any


class Span(NamedTuple):
    """Bytes that the line sends to the host, and what they are.

    Attributes:
        data: the bytes.
        made: the reply that the faults turned into these bytes; None: no reply.
        label: ``reply``: exactly that reply. ``echo``: the request's own bytes. ``damage``:
            anything else.
    """

    data: bytes
    made: Made | None
    label: str


class NumberingArm:
    """A peer that replies to every request at once, and numbers its replies."""

    wait = None

    def __init__(self, codec: Codec, clock: Callable[[], float]) -> None:
        self.received: list[tuple[float, bytes]] = []
        self.made: list[Made] = []
        self.last: Made | None = None
        self.arrived = b""
        self._codec = codec
        self._clock = clock
        self._numbers = itertools.count(1)

    def receive(self, data: bytes) -> bytes:
        """Receive what the faults left of a request; return the reply."""
        self.last = None
        # Each chunk is one request, so an incomplete request stays incomplete.
        session = DeviceSession(self._codec)
        for event in (*session.receive(data), *session.flush()):
            if isinstance(event, RequestReceived):
                self._handle(event)
        return b"" if self.last is None else self.last.frame

    def flush(self) -> bytes:
        """Return nothing: each reply was sent at once."""
        return b""

    def _handle(self, event: RequestReceived) -> None:
        command, request = event.message.command, event.frame.data
        now, damaged = self._clock(), request != self.arrived
        if not damaged:
            self.received.append((now, request))
        if command.requires_reply:
            values = reply_values(command, next(self._numbers), event.message.fields)
            frame = self._codec.encode(command.name, "reply", list(values.values()))
            self.last = Made(
                frame, request, now, damaged, result_of(self._codec, command.name, frame)
            )
        elif command.ack:
            frame = self._codec.encode(command.name, "reply", [1])
            self.last = Made(frame, request, now, damaged, None)
        if self.last is not None:
            self.made.append(self.last)


def result_of(codec: Codec, name: str, frame: bytes) -> Any:
    """Return what a call of the command returns if it gets this reply."""
    message = codec.decode("reply", frame, of=name)
    [field] = [field.name for field in message.variant.fields if not field.echo]
    return message.fields[field]


class HostilePeer(FaultyPeer):
    """A faulty peer around the numbering arm; it labels each byte that it sends."""

    def __init__(self, codec: Codec, faults: Sequence[Fault], seed: int) -> None:
        self.arm = NumberingArm(codec, time.monotonic)
        super().__init__(self.arm, codec, choosers(tuple(faults), seed), clock=time.monotonic)
        self.outlet = LabellingOutlet(self.arm)
        self._connection.outlet = self.outlet

    def _handle_events(self, events: Sequence[Event]) -> None:
        for event in events:
            self.arm.arrived = event.data
            super()._handle_events([event])

    def _exchange(self, data: bytes, chosen: Chosen) -> None:
        self.arm.last = None
        super()._exchange(data, chosen)


class LabellingOutlet(Outlet):
    """An outlet that labels the bytes it sends; ``sent`` has all of them, in their order."""

    def __init__(self, arm: NumberingArm) -> None:
        super().__init__()
        self.sent: list[Span] = []
        self._arm = arm
        self._planned: dict[int, list[Span]] = {}
        self._labelled: list[Span] | None = None
        self._held_spans: list[Span] = []
        self._taken = 0

    def put(self, at: float, reply: Reply, number: int | None = None) -> None:
        if reply:
            before = self._held_spans if self.holds else []
            self._labelled = before + self._label(joined(reply))
        super().put(at, reply, number)

    def hold(self, until: float, reply: Reply, number: int | None = None) -> None:
        self._held_spans = self._label(joined(reply))
        super().hold(until, reply, number)

    def take(self, now: float) -> bytes:
        data = super().take(now)
        self._taken += len(data)
        return data

    def drop(self) -> int:
        # If the line breaks while a reply is sent, the rest of the reply is lost.
        unsent = sum(len(span.data) for span in self.sent) - self._taken
        while unsent > 0:
            span = self.sent.pop()
            left = max(0, len(span.data) - unsent)
            unsent -= len(span.data) - left
            if left:
                self.sent.append(Span(span.data[:left], span.made, "damage"))
        self._planned.clear()
        return super().drop()

    def _push(self, at: float, reply: Reply, numbers: tuple[int, ...]) -> None:
        super()._push(at, reply, numbers)
        spans, self._labelled = self._labelled, None
        self._planned[self._count] = self._held_spans if spans is None else spans

    def _begin(self, now: float) -> bool:
        if not self._sending and self._due and self._due[0].at <= now:
            self.sent += self._planned.pop(self._due[0].order)
        return super()._begin(now)

    def _label(self, data: bytes) -> list[Span]:
        """Find the reply in the bytes that the faults made; label the rest as echo or damage."""
        made = self._arm.last
        spans: list[Span] = []
        while data:
            start = data.find(made.frame) if made is not None else -1
            other = data if start < 0 else data[:start]
            if other:
                label = "echo" if other == self._arm.arrived else "damage"
                spans.append(Span(other, made, label))
            if made is not None and start >= 0:
                spans.append(Span(made.frame, made, "reply"))
            data = data[len(other) + (len(made.frame) if made is not None and start >= 0 else 0) :]
        return spans
