"""Find the pauses in a recording: a cable that was unplugged, a program that stopped."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from cobotwire.codec.arrow import as_array


class Gaps:
    """Counts the pauses between the messages of one interface, both directions together."""

    def __init__(self, longest_ns: int) -> None:
        """Count pauses that are longer than ``longest_ns``."""
        self._longest_ns = longest_ns
        self._last_ns: int | None = None

    def take(self, times: Sequence[Any]) -> int:
        """Take the times of the next messages, in any order; return the number of pauses."""
        arrays = [times_of for each in times if len(times_of := as_array(each).cast(pa.int64()))]
        if not arrays:
            return 0
        before = [] if self._last_ns is None else [pa.array([self._last_ns], pa.int64())]
        joined = pa.concat_arrays([*before, *arrays])
        ordered = joined.take(pc.array_sort_indices(joined))
        self._last_ns = ordered[-1].as_py()
        pauses = pc.subtract(ordered[1:], ordered[:-1])
        return pc.sum(pc.greater(pauses, self._longest_ns)).as_py() or 0
