"""What happens to a stream on its way, and the truth about each frame after it.

Whatever happens is a list of edits: at this place so many bytes vanish, and those come instead. A
frame is damaged if an edit touches the inside of it; noise in front of a frame leaves it whole.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

import field_noise
from cobotwire.table import Table
from field_noise import Maker
from streams import Line, Marks, Places


class Edit(NamedTuple):
    """At ``place`` of what was sent, ``removed`` bytes vanish and ``data`` comes instead."""

    place: int
    removed: int
    data: bytes


Edits = list[Edit]

# Kinds of bytes that come in between, anywhere or only in front of frames.
ANYWHERE: dict[str, Maker] = {
    "servo": field_noise.servo,
    "text": field_noise.text,
    "nulls": field_noise.nulls,
    "garbage": field_noise.garbage,
}
IN_FRONT: dict[str, Maker] = {
    "ack": field_noise.ack,
    "header bytes": field_noise.header_bytes,
    "false header": field_noise.false_header,
}
KINDS = ("drop", "flip", "insert", *ANYWHERE, *IN_FRONT, "mixed")
# The parts of line noise, and how often each is drawn.
LINE_NOISE: dict[Maker, float] = {
    field_noise.servo: 6,
    field_noise.complaint: 2,
    field_noise.nulls: 1,
    field_noise.header_bytes: 3,
    field_noise.false_header: 3,
    field_noise.garbage: 3,
    field_noise.cursed: 3,
}


def damage(table: Table, line: Line, kind: str, rate: float, *, seed: int = 2) -> Line:
    """``line`` with damage of one kind; ``rate`` is how often it happens for each byte sent.

    ``mixed`` is all the others in equal shares. A flip turns one bit over, an insertion is one byte
    of any value, an ``ack`` stands glued to the front of a get_angles reply.
    """
    random = np.random.default_rng(seed)
    kinds = KINDS[:-1] if kind == "mixed" else (kind,)
    heads = field_noise.legal_heads(table)
    edits: Edits = []
    for each in kinds:
        edits += _edits(table, line, each, rate / len(kinds), heads, random)
    return apply(line, edits)


def noisy(
    table: Table,
    line: Line,
    *,
    share: float = 0.1,
    kinds: Mapping[Maker, float] = LINE_NOISE,
    inside: float = 0.05,
    seed: int = 3,
) -> Line:
    """``line`` with line noise between the frames, until ``share`` of all bytes are noise.

    ``inside`` is how much of the noise comes at any place, and so cuts most often into a frame.
    """
    random = np.random.default_rng(seed)
    pool = _pool(table, kinds, random)
    average = sum(map(len, pool)) / len(pool)
    pieces = max(1, int(len(line.data) * share / (1 - share) / average))
    places = np.unique(
        np.where(
            random.random(pieces) < inside,
            random.integers(0, len(line.data), pieces),
            random.choice(line.starts, pieces),
        )
    )
    # Two pieces for one place stand there one behind the other.
    bursts = np.full(len(places), pieces // len(places))
    bursts[: pieces % len(places)] += 1
    picks = iter(random.integers(0, len(pool), pieces).tolist())
    edits = [
        Edit(place, 0, b"".join(pool[next(picks)] for _ in range(burst)))
        for place, burst in zip(places.tolist(), random.permutation(bursts).tolist())
    ]
    return apply(line, edits)


def _pool(table: Table, kinds: Mapping[Maker, float], random: np.random.Generator) -> list[bytes]:
    # Pieces are picked from a few thousand; to make each of a million would take a minute.
    heads, makers = field_noise.legal_heads(table), list(kinds)
    odds = np.array([kinds[maker] for maker in makers], np.float64)
    which = random.choice(len(makers), 4096, p=odds / odds.sum())
    return [makers[index](heads, random) for index in which]


def apply(line: Line, edits: Edits) -> Line:
    """``line`` after the edits, of which only the first counts where two have one place."""
    assert line.whole.all(), "truth is known for a stream that was not damaged before"
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
    data = _spliced(line.data, edits)
    # What comes in exactly in front of a frame moves it; what vanishes there damages it.
    pure = np.where(removed == 0, 1, 0)
    before_start = np.searchsorted(places * 2 + 1 - pure, line.starts * 2 + 1)
    before_end = np.searchsorted(places, line.ends)
    acks = [i for i, edit in enumerate(edits) if edit.data == field_noise.ACK]
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


def _spliced(data: bytes, edits: Edits) -> bytes:
    pieces, at = [], 0
    for edit in edits:
        pieces += [data[at : edit.place], edit.data]
        at = edit.place + edit.removed
    return b"".join([*pieces, data[at:]])


def _mended(line: Line) -> Line:
    """Marks as whole what a damage left, or made again, just as it was sent.

    A doubled first byte is such a damage: the frame then stands one byte further on.
    """
    for index in np.flatnonzero(~line.whole).tolist():
        sent, start, end = line.original(index), int(line.starts[index]), int(line.ends[index])
        for place in (start, end - len(sent)):
            if place >= 0 and line.data[place : place + len(sent)] == sent:
                line.starts[index], line.ends[index] = place, place + len(sent)
                line.whole[index] = True
                break
    return line


def _edits(
    table: Table,
    line: Line,
    kind: str,
    rate: float,
    heads: Sequence[bytes],
    random: np.random.Generator,
) -> Edits:
    count = random.binomial(len(line.data), rate)
    if kind in IN_FRONT:
        fronts = _angles_replies(table, line) if kind == "ack" else line.starts
        places = random.choice(fronts, min(count, len(fronts)), replace=False)
    else:
        places = random.choice(len(line.data), count, replace=False)
    happens = _happens(kind, line.data, heads, random)
    return [happens(place) for place in places.tolist()]


def _happens(
    kind: str, data: bytes, heads: Sequence[bytes], random: np.random.Generator
) -> Callable[[int], Edit]:
    if kind == "drop":
        return lambda place: Edit(place, 1, b"")
    if kind == "flip":
        return lambda place: Edit(place, 1, bytes([data[place] ^ 1 << int(random.integers(8))]))
    if kind == "insert":
        return lambda place: Edit(place, 0, random.bytes(1))
    maker = {**ANYWHERE, **IN_FRONT}[kind]
    return lambda place: Edit(place, 0, maker(heads, random))


def _angles_replies(table: Table, line: Line) -> Places:
    command = table.command("get_angles")
    head = table.frame.header + bytes([table.frame.length(command.reply[0].size), command.id])
    found: Marks = np.array(
        [line.data.startswith(head, start) for start in line.starts.tolist()], np.bool_
    )
    return line.starts[found]
