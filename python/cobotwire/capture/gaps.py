"""Find the pauses in a recording: a cable that was unplugged, a program that stopped."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator


class Gaps:
    """Finds the pauses on one interface, both directions together."""

    def __init__(self, longest_ns: int) -> None:
        """Find pauses that are longer than ``longest_ns``."""
        self._longest_ns = longest_ns
        self._last_ns: int | None = None

    def take(self, times: Iterable[int]) -> Iterator[tuple[int, int]]:
        """Take the times of the next messages, in any order; yield both ends of each pause."""
        ordered = sorted(times)
        if self._last_ns is not None:
            ordered = [self._last_ns, *ordered]
        at, last = 0, len(ordered) - 1
        while at < last:
            # A range of times that is not longer than the limit contains no pause: skip it.
            near = bisect_right(ordered, ordered[at] + self._longest_ns, at) - 1
            if near == at:
                near += 1
                yield ordered[at], ordered[near]
            at = near
        self._last_ns = max(ordered, default=None)
