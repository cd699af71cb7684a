"""The bytes of one direction on one line, for ``cobotwire decode``: cut, diagnosed, in words."""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Iterable
from typing import Any, NamedTuple

from cobotwire.capture import CaptureReader, Packet
from cobotwire.cli import show
from cobotwire.cli.recorded import ARROWS, codec_of
from cobotwire.codec.interface import Codec, Frame, Listening
from cobotwire.diagnose import Diagnoser, Item
from cobotwire.explain import DIRECTIONS

LISTENING: dict[str, Listening] = {"sent": "request", "heard": "reply"}
# What stood still for so long in a recording waits for its rest no longer, as in the recorder.
IDLE_NS = 500_000_000


class Look(NamedTuple):
    """How it is wanted; ``direction`` is that of bytes that do not tell it themselves."""

    edition: str
    direction: Listening
    accept_unknown: bool
    each_byte: bool
    as_json: bool
    colour: bool


class Strand:
    """A framer, a diagnoser on top, and the ways in which its frames may be read."""

    def __init__(self, codec: Codec, listening: Listening, look: Look) -> None:
        self.framer = codec.framer(listening, accept_unknown=look.accept_unknown)
        self.read = show.reader(codec, tuple(d for d in DIRECTIONS if listening in (d, "both")))
        self.diagnoser = Diagnoser(codec, listening)
        self.show = show.on_a_line(self.read, look.colour)
        if look.as_json:
            self.show = show.as_json(self.read)
        elif look.each_byte:
            self.show = show.byte_by_byte(self.read, codec.table.frame)

    def feed(self, data: bytes) -> list[Item]:
        """What has become certain by these bytes."""
        return self.diagnoser.feed(self.framer.feed(data))

    def flush(self) -> list[Item]:
        """Nothing more comes, or not soon."""
        return self.diagnoser.feed(self.framer.flush()) + self.diagnoser.flush()


class RecordedStrand(Strand):
    """The packets of one direction of a recording, joined, each byte with its time."""

    def __init__(self, codec: Codec, packet: Packet, url: str, label: str, look: Look) -> None:
        super().__init__(codec, LISTENING.get(packet.direction, look.direction), look)
        self._direction, self._url, self._label = packet.direction, url, label
        self._as_json = look.as_json
        # Where in the strand what came together starts, and when it came; what is read is dropped.
        self._times: deque[tuple[int, int]] = deque()
        self._fed = 0

    def over(self, packet: Packet) -> bool:
        """Whether what waits here stood still until this packet came, in whatever direction."""
        return bool(self._times) and packet.time_ns >= self._times[-1][1] + IDLE_NS

    def take(self, packet: Packet) -> list[Item]:
        """The next packet of this direction."""
        for size, time_ns in packet.pieces or ((len(packet.data), packet.time_ns),):
            self._times.append((self._fed, time_ns))
            self._fed += size
        return self.feed(packet.data)

    def shown(self, item: Item, start_ns: int) -> str:
        """An item with its time; items come in the order of their offsets."""
        while len(self._times) > 1 and self._times[1][0] <= item.offset:
            self._times.popleft()
        time_ns = self._times[0][1]
        after = (time_ns - start_ns) / 1e9
        if not self._as_json:
            return f"{after:10.6f}{self._label} {ARROWS[self._direction]} {self.show(item)}"
        when: dict[str, Any] = {"time_ns": time_ns, "after": after, "url": self._url}
        said = show.as_object(self.read, item)
        return json.dumps({**when, "direction": self._direction, **said})


class Strands:
    """The strands of a recording; made when the first packet of their kind comes."""

    def __init__(self, capture: CaptureReader, look: Look) -> None:
        self.all: dict[tuple[int, str], RecordedStrand] = {}
        self._capture, self._look = capture, look

    def items(self) -> Iterable[tuple[RecordedStrand, list[Item], int]]:
        """What becomes certain, as it does; with the time of the recording's first packet."""
        start = 0
        for packet in self._capture:
            start = start or packet.time_ns
            for strand in self.all.values():
                if strand.over(packet):
                    yield strand, strand.flush(), start
            strand = self._strand(packet)
            items = strand.take(packet)
            self._tell_echoes(packet, items)
            yield strand, items, start
        for strand in self.all.values():
            yield strand, strand.flush(), start

    def _strand(self, packet: Packet) -> RecordedStrand:
        key = packet.interface, packet.direction
        if key not in self.all:
            lines = self._capture.interfaces
            codec = codec_of(self._capture, packet.interface, self._look.edition)
            label = f" line {packet.interface}" if len(lines) > 1 else ""
            url = lines[packet.interface].url
            self.all[key] = RecordedStrand(codec, packet, url, label, self._look)
        return self.all[key]

    def _tell_echoes(self, packet: Packet, items: list[Item]) -> None:
        """What was sent and comes back is an echo for sure."""
        if packet.direction == "sent":
            heard = self._strand(packet._replace(direction="heard"))
            for item in items:
                if isinstance(item, Frame):
                    heard.diagnoser.sent(item.data)
