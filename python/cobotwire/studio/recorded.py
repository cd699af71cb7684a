"""A recording: its entries, and the player of each page that watches it."""

from __future__ import annotations

import asyncio
import time
from bisect import bisect_left
from collections.abc import Iterator
from itertools import islice
from operator import attrgetter
from pathlib import Path
from typing import Any

from cobotwire.capture import CaptureReader, read
from cobotwire.capture.packet import Interface
from cobotwire.diagnose import Finding
from cobotwire.inspect.captured import codec_of_interface, diagnose_capture
from cobotwire.protocol.errors import CaptureError, EmptyInput, UsageError
from cobotwire.studio.describing import Described, Describer
from cobotwire.studio.entries import Entry
from cobotwire.studio.viewers import Viewer

# A longer recording is cut here, so that it fits into memory: some 300 bytes an entry.
MOST_ENTRIES = 1_000_000
STEP_SECONDS = 0.05
SLOWEST, FASTEST = 0.05, 1000.0
# After a jump, a page also gets this many entries before the target, and the samples of this many.
PAST_ENTRIES, PAST_SAMPLED = 400, 4000


class RecordedSession:
    """The entries of the first interface of a recording, in the order of their times."""

    def __init__(self, path: str, edition: str) -> None:
        """Read a recording; ``edition`` applies if the recording names none.

        Raises:
            UsageError: the file does not exist, or holds no packet.
            CaptureError: it is not a recording, or it is damaged.
        """
        with read(path) as capture:
            found = islice(_entries_of(capture, edition), MOST_ENTRIES + 1)
            timed = sorted(found, key=attrgetter("time_ns"))
            if not timed:
                raise EmptyInput(path)
            self.codec = codec_of_interface(capture, 0, edition)
            described = capture.interfaces[0]
            interfaces = len(capture.interfaces)
            incomplete = capture.incomplete if len(timed) <= MOST_ENTRIES else ""
        table = self.codec.table
        self.interface = Interface(described.url, table.edition, described.baudrate)
        self.start_ns = timed[0].time_ns
        self._entries = [each.entry(self.start_ns) for each in timed[:MOST_ENTRIES]]
        self._times = [entry.time for entry in self._entries]
        self.seconds = self._times[-1]
        self.remarks = [incomplete] * bool(incomplete)
        if len(timed) > MOST_ENTRIES:
            self.remarks.append(f"only the first {MOST_ENTRIES} entries are shown")
        if interfaces > 1:
            self.remarks.append(f"only the first of {interfaces} interfaces is shown")
        self.name = Path(path).name

    def find(self, number: int) -> Entry | None:
        """Return an entry by its number, or None."""
        return self._entries[number] if 0 <= number < len(self._entries) else None

    def entries(self) -> list[Entry]:
        """Return all entries."""
        return self._entries

    def index_at(self, seconds: float) -> int:
        """Return the number of the first entry at a time or after it."""
        return bisect_left(self._times, seconds)


class Player:
    """Plays a recording to one page."""

    def __init__(self, session: RecordedSession, viewer: Viewer) -> None:
        self._session, self._viewer = session, viewer
        self._describer = Describer(session.codec)
        self._next = 0
        self.position, self.speed, self.playing = 0.0, 1.0, False
        self.seek(0.0)

    def seek(self, seconds: float) -> None:
        """Jump to a time; the page gets what came shortly before it."""
        session = self._session
        self.position = min(max(seconds, 0.0), session.seconds)
        self._next = session.index_at(self.position + 1e-9)
        self._describer.restart()
        self._viewer.clear()
        first = max(0, self._next - PAST_ENTRIES)
        sampled = max(0, self._next - PAST_SAMPLED)
        self._viewer.push_past([], self._describer.samples(session.entries()[sampled:first]))
        self._viewer.push(list(self._described(first, self._next)))
        self._show()

    def play(self, speed: float) -> None:
        """Play from here, ``speed`` times as fast as it was recorded.

        Raises:
            UsageError: the speed is not allowed.
        """
        if not SLOWEST <= speed <= FASTEST:
            raise UsageError("speed", speed, f"{SLOWEST:g}..{FASTEST:g}")
        if self.position >= self._session.seconds:
            self.seek(0.0)
        self.speed, self.playing = speed, True
        self._show()

    def pause(self) -> None:
        """Stop playing."""
        self.playing = False
        self._show()

    async def run(self) -> None:
        """Play until the task is cancelled."""
        before = time.monotonic()
        while True:
            await asyncio.sleep(STEP_SECONDS)
            now = time.monotonic()
            passed, before = now - before, now
            if self.playing:
                self.advance(passed)

    def advance(self, seconds: float) -> None:
        """Play what comes in some seconds of real time."""
        session = self._session
        self.position = min(self.position + seconds * self.speed, session.seconds)
        until = session.index_at(self.position + 1e-9)
        self._viewer.push(self._described(self._next, until))
        self._next = until
        self.playing = self.position < session.seconds
        self._show()

    def _described(self, first: int, end: int) -> Iterator[Described]:
        entries = self._session.entries()
        return (self._describer.describe(at, entries[at]) for at in range(first, end))

    def _show(self) -> None:
        self._viewer.show(
            player={"position": self.position, "speed": self.speed, "playing": self.playing}
        )


class _Timed:
    __slots__ = ("data", "direction", "finding", "time_ns")

    def __init__(self, time_ns: int, direction: Any, data: bytes, finding: Finding | None) -> None:
        self.time_ns, self.direction, self.data, self.finding = time_ns, direction, data, finding

    def entry(self, start_ns: int) -> Entry:
        return Entry((self.time_ns - start_ns) / 1e9, self.direction, self.data, self.finding)


def _entries_of(capture: CaptureReader, edition: str) -> Iterator[_Timed]:
    """Yield the entries of the first interface, as far as the recording is intact."""
    try:
        for stream, items in diagnose_capture(capture, edition):
            if stream.interface:
                continue
            for item in items:
                finding = item if isinstance(item, Finding) else None
                yield _Timed(stream.time_of(item.offset), stream.direction, item.data, finding)
    except CaptureError:
        if not capture.interfaces:
            raise
