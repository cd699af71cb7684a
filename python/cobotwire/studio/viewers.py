"""The pages that watch. Each has its own queues, which drop old entries if the page is slow."""

from __future__ import annotations

import asyncio
import json
import secrets
from collections import deque
from collections.abc import AsyncIterator, Iterable
from typing import Any

from cobotwire.studio.describing import Described

# What waits for a page. A page that stalls for longer misses the oldest, and shows how many.
QUEUED_ENTRIES = 4000
QUEUED_SAMPLES = 8000
# Updates are collected for this long, so that a page draws about twenty times a second at most.
BATCH_SECONDS = 0.05


class Viewer:
    """One page that is open. All methods run in the loop's thread, and none waits."""

    def __init__(self) -> None:
        self.page = secrets.token_urlsafe(12)
        self.lost = 0
        self._entries: deque[str] = deque()
        self._samples: deque[str] = deque()
        # The newest state of each kind; older ones do not matter.
        self._states: dict[str, Any] = {}
        self._news = asyncio.Event()

    def push(self, described: Iterable[Described]) -> None:
        """Add entries and their samples; drop the oldest if the page is slow."""
        for each in described:
            self._entries.append(each.entry)
            self._samples.extend(each.samples)
        while len(self._entries) > QUEUED_ENTRIES:
            self._entries.popleft()
            self.lost += 1
        while len(self._samples) > QUEUED_SAMPLES:
            self._samples.popleft()
        self._news.set()

    def push_past(self, entries: Iterable[str], samples: Iterable[str]) -> None:
        """Add what happened before the page opened, or before the time that it jumped to."""
        self._entries.extend(entries)
        self._samples.extend(samples)
        self._news.set()

    def show(self, **states: Any) -> None:
        """Replace states, such as ``port`` or ``control``."""
        self._states |= states
        self._news.set()

    def clear(self) -> None:
        """Drop what waits, and let the page drop what it shows."""
        self._entries.clear()
        self._samples.clear()
        self.show(cleared=True)

    async def batches(self) -> AsyncIterator[str]:
        """Yield what is new, as JSON, when the caller has processed the previous batch."""
        while True:
            await self._news.wait()
            self._news.clear()
            entries, samples = ",".join(self._entries), ",".join(self._samples)
            states, self._states = self._states | {"lost": self.lost}, {}
            self._entries.clear()
            self._samples.clear()
            yield f'{{"entries":[{entries}],"samples":[{samples}],"states":{json.dumps(states)}}}'
            await asyncio.sleep(BATCH_SECONDS)
