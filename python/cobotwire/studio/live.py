"""A session with an arm: what comes from its line goes to the history and to all pages."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from typing import Any

from cobotwire import codec as codecs
from cobotwire.capture.packet import Interface
from cobotwire.inspect.following import FollowedRecording
from cobotwire.studio.arm_line import ArmLine
from cobotwire.studio.describing import Describer
from cobotwire.studio.entries import Entry, LiveEntries
from cobotwire.studio.history import History
from cobotwire.studio.viewers import Viewer

PUMP_SECONDS = 0.04
# The past entries that a new page gets.
FIRST_ENTRIES, FIRST_SAMPLES = 1000, 6000
REMARKS = 1000


class LiveSession:
    """The entries of one line, and the pages that watch it."""

    def __init__(
        self, line: ArmLine | FollowedRecording, remarks: deque[tuple[float, str, str]]
    ) -> None:
        """Start without entries; other threads add ``remarks``: the time, the kind and the text."""
        self.line = line
        self._start = time.monotonic()
        self.start_ns = time.time_ns()
        codec = codecs.load(line.table)
        self.interface = Interface(line.url, line.table.edition, line.baudrate)
        self._entries = LiveEntries(codec, self._start)
        self._describer = Describer(codec)
        self._remarks = remarks
        self.history = History()
        self.viewers: dict[str, Viewer] = {}
        self._problem = ""

    async def pump(self) -> None:
        """Pass on what comes, until the task is cancelled."""
        while True:
            self.pass_on()
            await asyncio.sleep(PUMP_SECONDS)

    def pass_on(self) -> None:
        """Pass on the bytes received since the last call."""
        new = [entry for traffic in self.line.take() for entry in self._entries.take(traffic)]
        new += self._entries.idle(time.monotonic())
        while self._remarks:
            at, label, text = self._remarks.popleft()
            new.append(Entry(at - self._start, "unknown", b"", remark=text, label=label))
        described = []
        for entry in new:
            found = self._describer.describe(self.history.count, entry)
            self.history.add(entry, found)
            described.append(found)
        for viewer in self.viewers.values():
            if described:
                viewer.push(described)
        if self.line.problem != self._problem:
            self._problem = self.line.problem
            self.show(**self.state())

    def open(self, viewer: Viewer) -> None:
        """Add a page; it gets the past first."""
        viewer.show(**self.state())
        entries, samples = self.history.last(FIRST_ENTRIES, FIRST_SAMPLES)
        viewer.push_past(entries, samples)
        self.viewers[viewer.page] = viewer

    def close(self, viewer: Viewer) -> None:
        """Remove a page."""
        self.viewers.pop(viewer.page, None)

    def show(self, **states: Any) -> None:
        """Show a state to all pages."""
        for viewer in self.viewers.values():
            viewer.show(**states)

    def state(self) -> dict[str, Any]:
        """Return the state of the port."""
        return {"port": {"url": self.line.url, "problem": self.line.problem}}

    def find(self, number: int) -> Entry | None:
        """Return an entry; None if it is no longer kept."""
        return self.history.find(number)

    def entries(self) -> list[Entry]:
        """Return the entries that are kept."""
        return self.history.entries()
