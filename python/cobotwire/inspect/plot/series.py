"""Collect the data of the charts: joints, coordinates, frames, noise and reply times."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from math import nan
from statistics import median
from typing import Literal

from cobotwire.capture import Packet
from cobotwire.capture.streams import cut
from cobotwire.codec.interface import Codec, Event, Frame, Noise
from cobotwire.inspect.plot.reply_times import Pairing, ReplyTimes
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Role

ROLES: tuple[Role, ...] = ("joints", "coordinates")
# There is a gap between two replies if they are more than this many usual intervals and more than
# this many seconds apart. The curves of the studio (`studio/page/series.js`) have the same rule.
GAP_INTERVALS, GAP_SECONDS = 4, 1.0


@dataclass
class Track:
    """The replies to one query: their positions on the axis, and the numbers of each.

    ``names`` and ``units`` belong to the numbers, as the edition has them.
    """

    names: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    at: list[float] = field(default_factory=list)
    rows: list[tuple[float, ...]] = field(default_factory=list)

    def with_gaps(self) -> tuple[list[float], list[tuple[float, ...]]]:
        """Return the times and the rows, with a row of NaN in each gap: no line crosses it."""
        intervals = [later - earlier for earlier, later in pairwise(self.at)]
        longest = max(GAP_SECONDS, GAP_INTERVALS * median(intervals)) if intervals else 0.0
        times, rows = self.at[:1], self.rows[:1]
        for at, row, since in zip(self.at[1:], self.rows[1:], intervals):
            if since > longest:
                times.append(at - since / 2)
                rows.append((nan,) * len(row))
            times.append(at)
            rows.append(row)
        return times, rows


@dataclass
class Series:
    """The contents of a recording or a stream of bytes, along an axis of time or offsets.

    Attributes:
        axis: ``seconds`` since the first packet, or ``bytes`` for a stream without times.
        end: the end of the axis.
        tracks: joints in degrees, coordinates in millimetres and degrees; may be empty.
        frames: the position of each frame that was not sent: received, or of unknown direction.
        noise: the position and the size in bytes of each span of noise that was not sent.
        start_ns: the time of the first packet, in nanoseconds since 1970; 0 without times.
        reply_times: the times between requests and replies; None without times or directions.
    """

    axis: Literal["seconds", "bytes"]
    end: float = 0.0
    tracks: dict[Role, Track] = field(default_factory=lambda: {role: Track() for role in ROLES})
    frames: list[float] = field(default_factory=list)
    noise: list[tuple[float, int]] = field(default_factory=list)
    start_ns: int = 0
    reply_times: ReplyTimes | None = None


def series_of_packets(packets: Iterable[Packet], codec: Codec) -> Series:
    """Collect the series of the packets of one interface.

    Raises:
        UsageError: there are no packets.
    """
    packets = list(packets)
    if not packets:
        raise UsageError("FILE", message="the recording holds no packets")
    # Not that of the first packet: the recorder's clock may have been set back meanwhile.
    start_ns = min(packet.time_ns for packet in packets)
    collector = _Collector(Series("seconds", start_ns=start_ns), codec)
    pairing = Pairing(codec.table)
    for stream, events, _ in cut(packets, lambda interface: codec):
        for event in events:
            time_ns = stream.time_of(event.offset + len(event.data) - 1)
            at = (time_ns - start_ns) / 1e9
            collector.series.end = max(collector.series.end, at)
            if stream.direction != "sent":
                collector.add(event, at)
            if isinstance(event, Frame) and stream.direction != "unknown":
                pair = pairing.sent if stream.direction == "sent" else pairing.received
                pair(at, event.command)
    if any(packet.direction != "unknown" for packet in packets):
        collector.series.reply_times = pairing.finish()
    return collector.series


def series_of_bytes(blocks: Iterable[bytes], codec: Codec) -> Series:
    """Collect the series of raw bytes.

    Raises:
        UsageError: there are no bytes.
    """
    collector = _Collector(Series("bytes"), codec)
    framer = codec.framer("both")
    for block in blocks:
        for event in framer.feed(block):
            collector.add(event, event.offset)
    for event in framer.flush():
        collector.add(event, event.offset)
    if not framer.counters.bytes:
        raise UsageError("FILE", message="the file is empty")
    collector.series.end = framer.counters.bytes
    return collector.series


class _Collector:
    """Adds frames and noise to a series."""

    def __init__(self, series: Series, codec: Codec) -> None:
        self.series = series
        self._tracks = {}
        for command in codec.table.commands:
            if command.role in ROLES:
                self._tracks[command.id] = track = series.tracks[command.role]
                numbers = command.reply[0].fields[-1].cases[0].numbers
                track.names = tuple(number.name for number in numbers)
                track.units = tuple(number.unit for number in numbers)

    def add(self, event: Event, at: float) -> None:
        if isinstance(event, Noise):
            self.series.noise.append((at, len(event.data)))
            return
        self.series.frames.append(at)
        track = self._tracks.get(event.command)
        if track is not None:
            self._add_values(track, event, at)

    def _add_values(self, track: Track, frame: Frame, at: float) -> None:
        try:
            [values] = frame.message.fields.values()
        except (ProtocolError, ValueError):
            # A reply with a value that the edition does not allow is not drawn.
            return
        track.at.append(at)
        track.rows.append(tuple(values))
