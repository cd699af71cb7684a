"""Score the frames that a reader found, against the ground truth of the line and the table."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cobotwire.codec.interface import Listening
from cobotwire.protocol.table import Table
from readers import Accepted
from streams import Line, Places, variants_of

Legal = set[bytes]
STEPS = tuple(range(0, 132, 4))  # bytes


@dataclass(frozen=True)
class Covered:
    """An undamaged frame that was not read, and the false frame that covers its start."""

    start: int
    false_start: int
    false_frame: bytes


@dataclass(frozen=True)
class Verdict:
    """The result of one reader on one line.

    Attributes:
        undamaged: how many frames arrived undamaged.
        recovered: how many of them were read.
        covered: undamaged frames that were lost because a legal false frame covers them.
        unexplained: the start of each undamaged frame that was lost, but not covered.
        altered: how many damaged frames are still legal, and were read with wrong values.
        restored: how many damaged frames were read as they were sent.
        phantoms: how many accepted frames were not sent at all.
        distances: the bytes from each damage to the next undamaged frame that was read.
    """

    undamaged: int
    recovered: int
    covered: list[Covered]
    unexplained: list[int]
    altered: int
    restored: int
    phantoms: int
    distances: Places

    @property
    def share(self) -> float:
        """The share of the undamaged frames that was recovered."""
        return self.recovered / self.undamaged if self.undamaged else 1.0


def legal_heads(table: Table, listening: Listening) -> Legal:
    """Return ``LEN CMD`` of every variant that the table allows in this direction."""
    variants = [variant for each in ("request", "reply") for variant in variants_of(table, each)]
    if listening != "both":
        variants = variants_of(table, listening)
    return {bytes([table.frame.length(variant.size), id]) for id, variant in variants}


def is_legal(table: Table, legal: Legal, frame: bytes) -> bool:
    """Return whether these bytes are one frame of the edition; use no codec."""
    size = frame[2] + 3 if len(frame) > 4 else -1
    return (
        frame.startswith(table.frame.header)
        and frame.endswith(table.frame.footer)
        and frame[2:4] in legal
        and len(frame) == size
    )


def score(table: Table, listening: Listening, line: Line, read: Sequence[Accepted]) -> Verdict:
    """Compare what was read with what was sent."""
    whole = np.flatnonzero(line.whole)
    starts, ends = line.starts[whole].tolist(), line.ends[whole].tolist()
    by_end = {frame.end: frame.data for frame in read}
    found = [by_end.get(end) == line.data[start:end] for start, end in zip(starts, ends)]
    lost = [start for start, ok in zip(starts, found) if not ok]
    covered, unexplained = _explain(table, listening, lost, read)
    true_ends = {end for end, ok in zip(ends, found) if ok}
    false_ones = [frame for frame in read if frame.end not in true_ends]
    altered, restored, phantoms = _sort_false(line, false_ones)
    return Verdict(
        len(whole),
        sum(found),
        covered,
        unexplained,
        altered,
        restored,
        phantoms,
        _distances(line.sites, [start for start, ok in zip(starts, found) if ok]),
    )


def ideal_distances(line: Line) -> Places:
    """Return the bytes from each damage to the next undamaged frame: the least possible."""
    return _distances(line.sites, line.starts[line.whole].tolist())


def as_json(verdict: Verdict) -> dict[str, Any]:
    """Return a verdict for the report's JSON."""
    return {
        "share": verdict.share,
        "lost": verdict.undamaged - verdict.recovered,
        "covered": len(verdict.covered),
        "altered": verdict.altered,
        "restored": verdict.restored,
        "phantoms": verdict.phantoms,
        "bytes_to_recovery": spread(verdict.distances),
    }


def spread(distances: Places) -> dict[str, Any]:
    """Return median, 99 % and maximum, and how many distances exceed each of ``STEPS``."""
    if not len(distances):
        return {"median": 0, "p99": 0, "max": 0, "longer": [0] * len(STEPS)}
    median, p99, most = np.quantile(distances, [0.5, 0.99, 1], method="higher").tolist()
    longer = [int((distances > step).sum()) for step in STEPS]
    return {"median": median, "p99": p99, "max": most, "longer": longer}


def _explain(
    table: Table, listening: Listening, lost: list[int], read: Sequence[Accepted]
) -> tuple[list[Covered], list[int]]:
    legal = legal_heads(table, listening)
    read_starts = [frame.start for frame in read]
    covered, unexplained = [], []
    for start in lost:
        index = bisect_left(read_starts, start) - 1
        frame = read[index] if index >= 0 else None
        if frame and frame.end > start and is_legal(table, legal, frame.data):
            covered.append(Covered(start, frame.start, frame.data))
        else:
            unexplained.append(start)
    return covered, unexplained


def _sort_false(line: Line, false_ones: Sequence[Accepted]) -> tuple[int, int, int]:
    damaged = np.flatnonzero(~line.whole).tolist()
    by_start = {int(line.starts[index]): index for index in damaged}
    by_end = {int(line.ends[index]): index for index in damaged}
    acks = set(line.acks.tolist())
    altered = restored = phantoms = 0
    for frame in false_ones:
        # If a reader skips bytes within a frame, the start of that frame is not known exactly.
        ended = by_end.get(frame.end)
        if ended is not None and frame.data == line.original(ended):
            restored += 1
        elif frame.start in by_start:
            altered += 1
        elif frame.start not in acks:
            phantoms += 1
    return altered, restored, phantoms


def _distances(sites: Places, starts: list[int]) -> Places:
    """Return the distance from each site to the next start; skip sites after the last start."""
    if not starts:
        return np.zeros(0, np.int64)
    places = np.array(starts, np.int64)
    reached = sites[sites <= places[-1]]
    ahead: Places = places[np.searchsorted(places, reached)] - reached
    return ahead
