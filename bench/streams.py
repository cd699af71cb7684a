"""Make byte streams from an edition's table, with the ground truth about every frame in them.

``frames_alike`` builds many frames of one variant at once, with random legal values. It uses NumPy
and no codec, so that no codec is tested with a stream that it encoded itself. The same seed gives
the same stream.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cobotwire.codec.interface import Listening
from cobotwire.protocol.table import Case, Direction, Number, Table, Variant

Bytes = NDArray[np.uint8]
Places = NDArray[np.int64]
Marks = NDArray[np.bool_]
VariantsById = Sequence[tuple[int, Variant]]


def _none() -> Places:
    return np.zeros(0, np.int64)


@dataclass(frozen=True)
class Line:
    """The bytes that a reader gets, and the ground truth about each frame in them.

    Attributes:
        data: the bytes.
        starts: where each frame, or what is left of it, starts.
        ends: where it ends.
        whole: whether it arrives as it was sent.
        sent: the undamaged bytes, and where each frame starts in them.
        sites: the place after each damage.
        acks: the starts of added acknowledgements. They are noise if the edition has none, but
            accepting them is never a mistake.
    """

    data: bytes
    starts: Places
    ends: Places
    whole: Marks
    sent: tuple[bytes, Places] = field(repr=False)
    sites: Places = field(default_factory=_none)
    acks: Places = field(default_factory=_none)

    @property
    def frames(self) -> int:
        """The number of frames that were sent."""
        return len(self.starts)

    def original(self, index: int) -> bytes:
        """Return frame ``index`` as it was sent."""
        data, starts = self.sent
        size = starts[index + 1] if index + 1 < len(starts) else len(data)
        return data[starts[index] : size]


def stream_a(table: Table, count: int, *, seed: int = 1) -> Line:
    """Make stream A of the speed tables: 60 % get_angles, 20 % get_coords, 20 % short replies."""
    angles, coords = (_reply(table, name) for name in ("get_angles", "get_coords"))
    short = [variant for variant in variants_of(table, "reply") if variant[1].size <= 2]
    shares = [0.6, 0.2, *[0.2 / len(short)] * len(short)]
    return _mixed(table, [angles, coords, *short], shares, count, seed)


def catalogue(table: Table, count: int, listening: Listening, *, seed: int = 1) -> Line:
    """Make a stream with each variant of each message equally often, with random legal values."""
    directions: tuple[Direction, ...] = (
        ("request", "reply") if listening == "both" else (listening,)
    )
    variants = [variant for direction in directions for variant in variants_of(table, direction)]
    return _mixed(table, variants, [1 / len(variants)] * len(variants), count, seed)


def variants_of(table: Table, direction: Direction) -> list[tuple[int, Variant]]:
    """Return every variant of the edition's messages in one direction, with its id."""
    return [
        (command.id, variant)
        for command in table.commands
        for variant in command.variants(direction)
    ]


def frames_alike(
    table: Table, id: int, variant: Variant, count: int, random: np.random.Generator
) -> Bytes:
    """Return ``count`` frames of one variant, one in each row."""
    assert table.frame.check is None, "other checks depend on the data"
    head = table.frame.start(id, table.frame.length(variant.size))
    footer = table.frame.footer
    body = [
        _words(number, raws[:, place])
        for part, raws in zip(variant.fields, _values(variant, count, random))
        for place, number in enumerate(part.cases[0].numbers)
    ]
    rows = [np.tile(np.frombuffer(part, np.uint8), (count, 1)) for part in (head, footer)]
    return np.concatenate([rows[0], *body, rows[1]], axis=1)


def _values(variant: Variant, count: int, random: np.random.Generator) -> list[Places]:
    """Draw legal raw values of each field, one frame in each row; draw selectors first."""
    drawn: dict[int, Places] = {}
    for index, part in sorted(enumerate(variant.fields), key=lambda each: each[1].selector >= 0):
        if part.choices:
            size = (count, len(part.cases[0].numbers))
            drawn[index] = random.choice(np.array(part.choices), size)
        elif part.selector < 0:
            drawn[index] = _drawn(part.cases[0], count, random)
        else:
            drawn[index] = _picked(part.cases, drawn[part.selector][:, 0], random)
    return [drawn[index] for index in range(len(variant.fields))]


def _reply(table: Table, name: str) -> tuple[int, Variant]:
    command = table.command(name)
    return command.id, command.reply[0]


def _mixed(
    table: Table, variants: VariantsById, shares: Sequence[float], count: int, seed: int
) -> Line:
    random = np.random.default_rng(seed)
    which = random.choice(len(variants), count, p=shares)
    all_sizes = np.array([table.frame.overhead + table.frame.length(f.size) for _, f in variants])
    sizes = all_sizes[which].astype(np.int64)
    ends = np.cumsum(sizes)
    starts = ends - sizes
    data = np.zeros(int(ends[-1]) if count else 0, np.uint8)
    for index, (id, variant) in enumerate(variants):
        places = starts[which == index]
        rows = frames_alike(table, id, variant, len(places), random)
        for column in range(rows.shape[1]):
            data[places + column] = rows[:, column]
    bytes_ = data.tobytes()
    return Line(bytes_, starts, ends, np.ones(count, np.bool_), (bytes_, starts))


def _drawn(case: Case, count: int, random: np.random.Generator) -> Places:
    return np.stack(
        [random.integers(n.minimum, n.maximum, count, endpoint=True) for n in case.numbers], axis=1
    )


def _picked(cases: Sequence[Case], selector: Places, random: np.random.Generator) -> Places:
    drawn = np.zeros((len(selector), len(cases[0].numbers)), np.int64)
    for case in cases:
        rows = np.isin(selector, case.when)
        drawn[rows] = _drawn(case, int(rows.sum()), random)
    return drawn


def _words(number: Number, raws: Places) -> Bytes:
    order = range(number.width) if number.order == "little" else range(number.width - 1, -1, -1)
    return np.stack([(raws >> 8 * place & 0xFF).astype(np.uint8) for place in order], axis=1)
