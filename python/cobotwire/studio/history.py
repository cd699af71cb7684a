"""The last entries of a session, for pages that open later, for explanations and for exports."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterable
from itertools import islice
from typing import TypeVar

from cobotwire.studio.describing import Described
from cobotwire.studio.entries import Entry

# Pages keep fewer, so that what they show can be explained.
KEPT_ENTRIES = 20_000
KEPT_SAMPLES = 12_000

T = TypeVar("T")


class History:
    """Keeps the last entries; the number of an entry counts from the start of the session."""

    def __init__(self) -> None:
        self.count = 0
        self._lock = threading.Lock()
        self._entries: deque[tuple[Entry, str]] = deque(maxlen=KEPT_ENTRIES)
        self._samples: deque[str] = deque(maxlen=KEPT_SAMPLES)

    def add(self, entry: Entry, described: Described) -> None:
        """Add the entry with the number ``count``."""
        with self._lock:
            self._entries.append((entry, described.entry))
            self._samples.extend(described.samples)
            self.count += 1

    def find(self, number: int) -> Entry | None:
        """Return an entry; None if there is none of that number, or it is too old."""
        with self._lock:
            index = number - (self.count - len(self._entries))
            return self._entries[index][0] if 0 <= index < len(self._entries) else None

    def entries(self) -> list[Entry]:
        """Return all entries that are kept, the oldest first."""
        with self._lock:
            return [entry for entry, _ in self._entries]

    def last(self, entries: int, samples: int) -> tuple[list[str], list[str]]:
        """Return the last entries and samples as JSON, the oldest first."""
        with self._lock:
            shown = [text for _, text in _last(self._entries, entries)]
            return shown, list(_last(self._samples, samples))


def _last(kept: deque[T], count: int) -> Iterable[T]:
    return islice(kept, max(0, len(kept) - count), None)
