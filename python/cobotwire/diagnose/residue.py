"""Hold the noise of a stream that no finding covers yet, without the frames in between."""

from __future__ import annotations

import re
from bisect import bisect_right
from enum import Enum
from itertools import pairwise

from cobotwire.codec.interface import Noise, NoiseReason
from cobotwire.diagnose.findings import Finding, Span


class Wait(Enum):
    """What a recogniser returns if it needs more bytes."""

    WAIT = 0


# A finding that starts there, or None if nothing does, or Wait if more bytes are needed.
Verdict = Finding | Wait | None

_LINE_END = re.compile(rb"\r?\n|\r")


class Residue:
    """Consecutive bytes of noise, with marks where frames interrupted them.

    A servo packet or a line of text may continue after a frame, so its recogniser sees all of
    ``data``. All other noise ends at a mark: its recogniser gets a :meth:`segment_end`.
    """

    def __init__(self) -> None:
        self.data = b""
        # Whether no later byte can belong to ``data``.
        self.closed = False
        # Whether the bytes to recognise come directly after text.
        self.after_text = False
        self._marks: list[int] = []
        self._starts: list[int] = []
        self._pieces: list[tuple[int, NoiseReason]] = []
        self._added: list[bytes] = []
        self._size = 0

    def __bool__(self) -> bool:
        return self._size > 0

    def add(self, noise: Noise) -> None:
        """Add noise; :meth:`join` appends it to ``data``."""
        self._starts.append(self._size)
        self._pieces.append((noise.offset, noise.reason))
        self._added.append(noise.data)
        self._size += len(noise.data)

    def mark(self) -> None:
        """Mark that a frame interrupts the noise here."""
        if self._size and self._marks[-1:] != [self._size]:
            self._marks.append(self._size)

    def join(self) -> None:
        """Append what was added to ``data``."""
        self.data = b"".join((self.data, *self._added))
        self._added.clear()

    def segment_end(self, at: int) -> tuple[int, bool]:
        """Return where the bytes at ``at`` end before the next frame, and whether that is final."""
        index = bisect_right(self._marks, at)
        if index < len(self._marks):
            return self._marks[index], True
        return len(self.data), self.closed

    def line_end(self, at: int) -> int | Wait:
        """Return the offset after the line end at ``at``; ``at`` itself if there is no line end."""
        limit, final = self.segment_end(at)
        found = _LINE_END.match(self.data, at, limit)
        end = found.end() if found else at
        undecided = end == limit and self.data[at:end] in (b"", b"\r")
        return Wait.WAIT if undecided and not final else end

    def reason(self, at: int) -> NoiseReason:
        """Return the framer's reason for the byte at ``at``."""
        return self._pieces[bisect_right(self._starts, at) - 1][1]

    def spans(self, start: int, end: int) -> tuple[Span, ...]:
        """Return the spans of the stream that the bytes from ``start`` to ``end`` come from."""
        first, last = bisect_right(self._marks, start), bisect_right(self._marks, end - 1)
        cuts = [start, *self._marks[first:last], end]
        return tuple(Span(self._offset(a), self.data[a:b]) for a, b in pairwise(cuts))

    def _offset(self, at: int) -> int:
        index = bisect_right(self._starts, at) - 1
        return self._pieces[index][0] + at - self._starts[index]

    def drop(self, count: int) -> None:
        """Remove the first ``count`` bytes, because findings cover them."""
        if not count:
            return
        first = bisect_right(self._starts, count) - 1
        head = (self._offset(count), self._pieces[first][1])
        self._starts = [0, *(start - count for start in self._starts[first + 1 :])]
        self._pieces = [head, *self._pieces[first + 1 :]]
        self._marks = [mark - count for mark in self._marks if mark > count]
        self.data = self.data[count:]
        self._size -= count
        if not self._size:
            self._starts, self._pieces = [], []
