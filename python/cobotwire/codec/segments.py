"""Divide a stream into segments that can be decoded on their own, and decode one of them.

A scan has no state: what it finds from a position on depends only on the bytes from there on. So
two scans that reach the same position agree from there on. A frame that begins before a cut ends
after it by less than the length of the longest frame. So the scan of the whole stream continues
after the cut at one of a few positions, and it is not known at which. Scans that start at each of
them meet at one position; the scan of the whole stream reaches it too. A segment extends from the
meeting point of one cut to that of the next one. To find a meeting point, only bytes after the cut
are needed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from heapq import heapify, heappop, heappush
from typing import NamedTuple, Protocol

from cobotwire.codec.columns import Columns
from cobotwire.codec.events import Counters, Frame, NoiseReason
from cobotwire.codec.interface import Codec, Listening
from cobotwire.protocol.frame_index import longest_frame
from cobotwire.protocol.table import Direction

# Scans that have not met within this many bytes probably never will; only bytes made on purpose
# keep them apart for so long. Then the cut is ignored: the segment before it continues.
PATIENCE = 1 << 16
# Bytes that are read and decoded at once.
CHUNK = 1 << 23


class Stream(Protocol):
    """The bytes of a stream, which can be read at any offset."""

    @property
    def size(self) -> int:
        """The number of bytes."""
        ...

    def read(self, offset: int, size: int) -> bytes:
        """Return ``size`` bytes from ``offset`` on, or as many as there are."""
        ...


class Segment(NamedTuple):
    """The bytes from ``start`` to before ``end``; the scan of the stream reaches both positions."""

    start: int
    end: int

    def __bool__(self) -> bool:
        return self.start < self.end


class Divider:
    """Divides a stream at cuts; a cut may be at any byte."""

    def __init__(
        self,
        codec: Codec,
        listening: Listening,
        stream: Stream,
        cuts: Sequence[int],
        patience: int = PATIENCE,
    ) -> None:
        """Take the cuts in their order; piece ``k`` lies between cut ``k - 1`` and cut ``k``."""
        self._codec = codec
        self._listening: Listening = listening
        self._stream = stream
        self._cuts = cuts
        self._patience = patience
        self._reach = _reach(codec, listening)

    def segment(self, piece: int) -> Segment:
        """Return the segment that belongs to a piece, counted from 0; it may be empty.

        The segments of all pieces, one after another, are the stream. If the scans after a cut do
        not meet within the patience, the piece after it has an empty segment.
        """
        cuts = self._cuts
        start = self.meeting_point(cuts[piece - 1]) if piece else 0
        if start is None:
            return Segment(0, 0)
        later = (self.meeting_point(cut) for cut in cuts[piece:])
        end = next((point for point in later if point is not None), self._stream.size)
        return Segment(start, end)

    def meeting_point(self, cut: int) -> int | None:
        """Return the first position from ``cut`` on that all scans from before it reach.

        None: they do not meet within the patience.
        """
        reach = self._reach
        window = self._stream.read(cut, self._patience + 2 * reach)
        # A frame that begins before the cut, and ends after it, ends at one of these.
        positions = list(range(min(reach, len(window) + 1)))
        heapify(positions)
        while True:
            at = heappop(positions)
            while positions and positions[0] == at:
                heappop(positions)
            if not positions:
                return cut + at
            if at > self._patience:
                return None
            heappush(positions, at + self._step(window[at : at + reach]))

    def _step(self, candidate: bytes) -> int:
        """Return the size of the frame at the start of ``candidate``; 1 if there is none."""
        framer = self._codec.framer(self._listening)
        first = [*framer.feed(candidate), *framer.flush()][0]
        return len(first.data) if isinstance(first, Frame) else 1


def decode_segment(
    codec: Codec,
    listening: Listening,
    stream: Stream,
    segment: Segment,
    *,
    raw: bool = False,
    chunk: int = CHUNK,
) -> Iterator[Columns]:
    """Yield the columns of a segment, chunk by chunk, with the offsets that the stream has.

    The counters of the last columns are those of the segment.
    """
    start, end = segment
    reader = codec.column_reader(listening, raw=raw, offset=start)
    counters = Counters(0, {}, {}, 0)
    for at in range(start, end, chunk):
        columns = reader.feed(stream.read(at, min(chunk, end - at)))
        counters = columns.counters
        yield columns
    waiting = reader.pending
    last = reader.flush()
    if waiting and end < stream.size:
        # No frame crosses the end of a segment, so the flush was right to reject the waiting bytes.
        # But the reasons depend on the bytes that follow.
        ahead = stream.read(end - waiting, waiting + _reach(codec, listening))
        noise = _with_reasons(counters, _noise_of(codec, listening, ahead, waiting))
        last.counters = last.counters._replace(noise=noise)
    yield last


def _noise_of(
    codec: Codec, listening: Listening, data: bytes, end: int
) -> Iterator[tuple[NoiseReason, int]]:
    """Yield the reasons of the noise in ``data`` before ``end``, with the number of bytes."""
    framer = codec.framer(listening)
    for event in [*framer.feed(data), *framer.flush()]:
        if not isinstance(event, Frame) and event.offset < end:
            yield event.reason, min(len(event.data), end - event.offset)


def _with_reasons(
    counters: Counters, more: Iterator[tuple[NoiseReason, int]]
) -> dict[NoiseReason, int]:
    noise = dict(counters.noise)
    for reason, size in more:
        noise[reason] = noise.get(reason, 0) + size
    return noise


def _reach(codec: Codec, listening: Listening) -> int:
    """Return the number of bytes that decide about a candidate, at most."""
    directions: tuple[Direction, ...] = (
        ("request", "reply") if listening == "both" else (listening,)
    )
    return max(longest_frame(codec.table, directions), codec.table.frame.head_size)


def even_cuts(size: int, piece: int) -> range:
    """Return the cuts that divide ``size`` bytes into pieces of ``piece`` bytes."""
    return range(piece, size, piece)
