"""The bytes that the line delivered, each with its time and its origin."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from attack.arm import Span
from attack.line import Delivered
from cobotwire.protocol.table import FrameFormat

# Longer than any reply.
LONGEST = 40


class Found(NamedTuple):
    """A frame in the delivered bytes.

    Attributes:
        at: when its last byte was delivered.
        data: its bytes.
        spans: the spans that hold the bytes, each with whether it is a further copy of a reply.
        torn: whether bytes between its own were lost when the line broke.
    """

    at: float
    data: bytes
    spans: list[tuple[Span, bool]]
    torn: bool


class Delivery:
    """Finds frames in what was delivered."""

    def __init__(
        self, format: FrameFormat, spans: Sequence[Span], delivered: Sequence[Delivered]
    ) -> None:
        self._format = format
        self._spans: list[tuple[Span, bool]] = []
        # Where each span begins in all bytes that the arm sent.
        self._offsets: list[int] = []
        offset, seen = 0, set[int]()
        for span in spans:
            self._offsets.append(offset)
            self._spans.append((span, span.label == "reply" and id(span.made) in seen))
            if span.label == "reply":
                seen.add(id(span.made))
            offset += len(span.data)
        self._chunks = delivered
        self._times = [chunk.at for chunk in delivered]
        # Where each chunk begins in the delivered bytes.
        self._starts: list[int] = []
        size = 0
        for chunk in delivered:
            self._starts.append(size)
            size += chunk.end - chunk.start
        sent = b"".join(span.data for span in spans)
        self._stream = b"".join(sent[chunk.start : chunk.end] for chunk in delivered)

    def frames(self, since: float, until: float) -> Iterator[Found]:
        """Yield everything that looks like a frame and ends between two times."""
        first, last = bisect_right(self._times, since), bisect_right(self._times, until)
        if first == last:
            return
        # A frame may have begun before the first of these bytes.
        start = max(0, self._starts[first] - LONGEST)
        end = self._starts[last - 1] + self._chunks[last - 1].end - self._chunks[last - 1].start
        while (start := self._stream.find(self._format.header, start, end)) >= 0:
            at = start + self._format.length_at
            size = self._format.overhead + self._stream[at] if at < end else 0
            if size and start + size <= end and self._at(start + size - 1) >= since:
                yield self._found(start, size)
            start += 1

    def _chunk(self, index: int) -> tuple[Delivered, int]:
        number = bisect_right(self._starts, index) - 1
        return self._chunks[number], index - self._starts[number]

    def _at(self, index: int) -> float:
        return self._chunk(index)[0].at

    def _found(self, start: int, size: int) -> Found:
        offsets = []
        for index in range(start, start + size):
            chunk, inside = self._chunk(index)
            offsets.append(chunk.start + inside)
        numbers = sorted({bisect_right(self._offsets, offset) - 1 for offset in offsets})
        return Found(
            at=self._at(start + size - 1),
            data=self._stream[start : start + size],
            spans=[self._spans[number] for number in numbers],
            torn=offsets[-1] - offsets[0] != size - 1,
        )
