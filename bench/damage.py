"""Damage a stream, and record which frames are damaged.

The simulator's faults make the damage as a list of edits: each edit removes a number of bytes at an
offset and inserts others. A frame is damaged if an edit touches its inside; noise before a frame
leaves it undamaged.
"""

from __future__ import annotations

from random import Random

import numpy as np

from cobotwire.protocol.table import Table
from cobotwire.simulator.faults import Corrupted, Dropped, Noise
from cobotwire.simulator.faults.fault import Damage
from cobotwire.simulator.faults.noise import NOISE, mixed_noise
from cobotwire.simulator.faults.stream import Edit, edited, edits
from streams import Line, Marks, Places

FAULTS: dict[str, Damage] = {
    "drop": Dropped(),
    "flip": Corrupted(),
    "insert": Noise(classes=("byte",)),
    **{
        name: Noise(classes=(name,))
        for name in ("servo", "text", "nuls", "garbage", "ack", "header bytes", "false header")
    },
}
BEFORE_FRAMES = tuple(name for name in FAULTS if name in NOISE and NOISE[name].before_frames)
KINDS = (*FAULTS, "mixed")
ACK = b"\xfe\xfe\x03\x10\x01\xfa"


def damage(table: Table, line: Line, kind: str, rate: float, *, seed: int = 2) -> Line:
    """Return ``line`` with damage of one kind; ``rate`` is its probability for each byte sent.

    ``mixed`` has equal shares of all other kinds. A flip changes one bit, an insertion adds one
    byte of any value, and an ``ack`` directly precedes a get_angles reply.
    """
    random = np.random.default_rng(seed)
    kinds = tuple(FAULTS) if kind == "mixed" else (kind,)
    found: list[Edit] = []
    for each in kinds:
        places = _places(table, line, each, rate / len(kinds), random)
        draws = Random(f"{seed} {each}")  # noqa: S311  (repeatable, no secret)
        found += edits(FAULTS[each], line.data, places.tolist(), table, draws)
    return apply(line, found)


def noisy(
    table: Table, line: Line, *, share: float = 0.1, inside: float = 0.05, seed: int = 3
) -> Line:
    """Return ``line`` with noise between its frames, so that ``share`` of all bytes are noise.

    ``inside`` is the share of the noise at random places, which are mostly inside a frame.
    """
    random = np.random.default_rng(seed)
    # Pieces are picked from a few thousand; drawing each of a million would take a minute.
    draws = Random(seed)  # noqa: S311  (repeatable, no secret)
    pool = [mixed_noise(draws, table) for _ in range(4096)]
    average = sum(map(len, pool)) / len(pool)
    pieces = max(1, int(len(line.data) * share / (1 - share) / average))
    places = np.unique(
        np.where(
            random.random(pieces) < inside,
            random.integers(0, len(line.data), pieces),
            random.choice(line.starts, pieces),
        )
    )
    # Pieces for the same place are inserted one after another.
    bursts = np.full(len(places), pieces // len(places))
    bursts[: pieces % len(places)] += 1
    picks = iter(random.integers(0, len(pool), pieces).tolist())
    return apply(
        line,
        [
            Edit(place, 0, b"".join(pool[next(picks)] for _ in range(burst)))
            for place, burst in zip(places.tolist(), random.permutation(bursts).tolist())
        ],
    )


def apply(line: Line, edits: list[Edit]) -> Line:
    """Return ``line`` after the edits; of several edits at one offset, apply only the first."""
    assert line.whole.all(), "edits are tracked only for a stream that is still undamaged"
    first = {edit.place: edit for edit in reversed(edits)}
    edits = [first[place] for place in sorted(first)]
    places, removed, sizes = (
        np.array(column, np.int64)
        for column in (
            [edit.place for edit in edits],
            [edit.removed for edit in edits],
            [len(edit.data) for edit in edits],
        )
    )
    shifts = np.concatenate([[0], np.cumsum(sizes - removed)])
    data = edited(line.data, edits)
    # Bytes that are added at the start of a frame move it; bytes that are removed damage it.
    pure = np.where(removed == 0, 1, 0)
    before_start = np.searchsorted(places * 2 + 1 - pure, line.starts * 2 + 1)
    before_end = np.searchsorted(places, line.ends)
    acks = [i for i, edit in enumerate(edits) if edit.data == ACK]
    moved = Line(
        data,
        line.starts + shifts[before_start],
        line.ends + shifts[before_end],
        before_start == before_end,
        line.sent,
        places + shifts[:-1] + sizes,
        (places + shifts[:-1])[acks],
    )
    return _mended(moved)


def _mended(line: Line) -> Line:
    """Mark as undamaged each frame that an edit only moved.

    An edit that doubles the first byte moves the frame by one byte.
    """
    for index in np.flatnonzero(~line.whole).tolist():
        sent, start, end = line.original(index), int(line.starts[index]), int(line.ends[index])
        for place in (start, end - len(sent)):
            if place >= 0 and line.data[place : place + len(sent)] == sent:
                line.starts[index], line.ends[index] = place, place + len(sent)
                line.whole[index] = True
                break
    return line


def _places(
    table: Table, line: Line, kind: str, rate: float, random: np.random.Generator
) -> Places:
    """Draw the places that are damaged: any bytes, or the first bytes of frames."""
    count = random.binomial(len(line.data), rate)
    if kind in BEFORE_FRAMES:
        starts = _angles_replies(table, line) if kind == "ack" else line.starts
        return random.choice(starts, min(count, len(starts)), replace=False)
    return random.choice(len(line.data), count, replace=False)


def _angles_replies(table: Table, line: Line) -> Places:
    command = table.command("get_angles")
    head = table.frame.header + bytes([table.frame.length(command.reply[0].size), command.id])
    found: Marks = np.array(
        [line.data.startswith(head, start) for start in line.starts.tolist()], np.bool_
    )
    return line.starts[found]
