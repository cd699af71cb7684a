"""What is drawn: joints, coordinates and the line's health, over time or over the bytes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal

from cobotwire.capture import Packet
from cobotwire.codec.interface import Codec, Event, Framer, Noise
from cobotwire.errors import ProtocolError, UsageError
from cobotwire.plot.replies import Pairing, Replies
from cobotwire.table import Command, Role

# What stood still for so long in a recording waits for its rest no longer, as in the recorder.
IDLE_NS = 500_000_000
# What a noisy line adds to a stream must not be read as a position.
ROLES: tuple[Role, ...] = ("joints", "coordinates")


@dataclass
class Track:
    """The answers to one query: where on the axis, and the numbers of each."""

    at: list[float] = field(default_factory=list)
    rows: list[tuple[float, ...]] = field(default_factory=list)


@dataclass
class Series:
    """What a recording or a stream holds.

    Attributes:
        axis: ``seconds`` since the first packet, or ``bytes``: a raw stream has no times.
        end: where the axis ends.
        tracks: joints in degrees, coordinates in millimetres and degrees; empty ones too.
        frames: where each heard frame stands.
        noise: where noise stands that was heard, and how many bytes it is.
        replies: how fast answers came; None where there are no times.
    """

    axis: Literal["seconds", "bytes"]
    end: float = 0.0
    tracks: dict[Role, Track] = field(default_factory=lambda: {role: Track() for role in ROLES})
    frames: list[float] = field(default_factory=list)
    noise: list[tuple[float, int]] = field(default_factory=list)
    replies: Replies | None = None


def of_recording(packets: Iterable[Packet], codec: Codec) -> Series:
    """The packets of one line.

    Raises:
        UsageError: there are none.
    """
    framers = {"sent": codec.framer("request"), "heard": codec.framer("reply")}
    collecting = _Collecting(Series("seconds"), codec)
    pairing = Pairing(codec.table)
    start: int | None = None
    last: dict[str, int] = {}
    for packet in packets:
        start = packet.time_ns if start is None else start
        # A recording of somebody else need not tell the direction; what an arm says is drawn.
        way = "sent" if packet.direction == "sent" else "heard"
        if packet.time_ns - last.get(way, packet.time_ns) >= IDLE_NS:
            _sort(framers[way].flush(), way, (last[way] - start) / 1e9, collecting, pairing)
        time_ns = packet.pieces[-1].time_ns if packet.pieces else packet.time_ns
        last[way] = time_ns
        at = (time_ns - start) / 1e9
        collecting.series.end = max(collecting.series.end, at)
        _sort(framers[way].feed(packet.data), way, at, collecting, pairing)
    if start is None:
        raise UsageError("FILE", "no packet", "a recording in which something is said")
    for way, framer in framers.items():
        _sort(framer.flush(), way, collecting.series.end, collecting, pairing)
    collecting.series.replies = pairing.end()
    return collecting.series


def of_stream(blocks: Iterable[bytes], codec: Codec) -> Series:
    """The raw bytes that an arm said, without times.

    Raises:
        UsageError: there are none.
    """
    collecting = _Collecting(Series("bytes"), codec)
    framer: Framer = codec.framer("reply")
    size = 0
    for block in blocks:
        size += len(block)
        for event in framer.feed(block):
            collecting.take(event, event.offset)
    for event in framer.flush():
        collecting.take(event, event.offset)
    if not size:
        raise UsageError("FILE", "no byte", "a stream in which something is said")
    collecting.series.end = size
    return collecting.series


class _Collecting:
    """Sorts what was heard into a series."""

    def __init__(self, series: Series, codec: Codec) -> None:
        self.series = series
        self._roles = {c.id: c for c in codec.table.commands if c.role in ROLES}

    def take(self, event: Event, at: float) -> None:
        if isinstance(event, Noise):
            self.series.noise.append((at, len(event.data)))
            return
        self.series.frames.append(at)
        command = self._roles.get(event.command)
        if command is not None:
            self._track(command, event, at)

    def _track(self, command: Command, event: Event, at: float) -> None:
        assert not isinstance(event, Noise), "a frame"
        try:
            [values] = event.message.fields.values()
        except (ProtocolError, ValueError):
            # An answer that the edition rules out is no position.
            return
        assert command.role is not None, "one of the roles that are drawn"
        track = self.series.tracks[command.role]
        track.at.append(at)
        track.rows.append(tuple(values))


def _sort(
    events: Iterable[Event], way: str, at: float, collecting: _Collecting, pairing: Pairing
) -> None:
    for event in events:
        if way == "heard":
            collecting.take(event, at)
        if not isinstance(event, Noise):
            (pairing.heard if way == "heard" else pairing.sent)(at, event.command)
