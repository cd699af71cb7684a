"""Byte streams made from an edition's table, together with the truth about every frame in them.

``frames_alike`` builds a thousand or a million frames of one form at once, with random legal
values, by NumPy and without any codec: what a reader makes of a stream is never judged by a stream
that the same code made. A seed gives the same stream always.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cobotwire.codec.interface import Listening
from cobotwire.table import Case, Direction, Layout, Number, Table

Bytes = NDArray[np.uint8]
Places = NDArray[np.int64]
Marks = NDArray[np.bool_]
Forms = Sequence[tuple[int, Layout]]


def _none() -> Places:
    return np.zeros(0, np.int64)


@dataclass(frozen=True)
class Line:
    """What a reader is given, and the truth: frame ``i`` was sent whole, or damaged on its way.

    ``starts[i]`` is where frame i (or what is left of it) starts in ``data``, and ``ends[i]`` where
    it ends; ``whole[i]`` says that it stands there just as it was sent, in ``sent``. ``sites`` are
    the places just behind each damage. ``acks`` are the starts of acknowledgements that came
    along: where the edition knows none they are noise, but to accept one is no mistake anywhere.
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
        """How many frames were sent."""
        return len(self.starts)

    def original(self, index: int) -> bytes:
        """Frame ``index`` as it was sent."""
        data, starts = self.sent
        size = starts[index + 1] if index + 1 < len(starts) else len(data)
        return data[starts[index] : size]


def stream_a(table: Table, count: int, *, seed: int = 1) -> Line:
    """Stream A of the speed tables: 60 % get_angles replies, 20 % get_coords, 20 % short ones."""
    angles, coords = (_reply(table, name) for name in ("get_angles", "get_coords"))
    short = [form for form in forms_of(table, "reply") if form[1].size <= 2]
    shares = [0.6, 0.2, *[0.2 / len(short)] * len(short)]
    return _mixed(table, [angles, coords, *short], shares, count, seed)


def catalogue(table: Table, count: int, listening: Listening, *, seed: int = 1) -> Line:
    """Every form of every message of an edition, each equally often, with random legal values."""
    directions: tuple[Direction, ...] = (
        ("request", "reply") if listening == "both" else (listening,)
    )
    forms = [form for direction in directions for form in forms_of(table, direction)]
    return _mixed(table, forms, [1 / len(forms)] * len(forms), count, seed)


def forms_of(table: Table, direction: Direction) -> list[tuple[int, Layout]]:
    """The id and the layout of every form of the edition's messages in one direction."""
    return [
        (command.id, layout) for command in table.commands for layout in command.layouts(direction)
    ]


def frames_alike(
    table: Table, id: int, layout: Layout, count: int, random: np.random.Generator
) -> Bytes:
    """``count`` frames of one form, a row each."""
    assert table.frame.check == "footer", "other checks depend on the data"
    head = table.frame.header + bytes(
        [*table.frame.addresses[:1], table.frame.length(layout.size), id]
    )
    footer = table.frame.footer
    body = [
        _words(number, wholes[:, place])
        for part, wholes in zip(layout.fields, _values(layout, count, random))
        for place, number in enumerate(part.cases[0].numbers)
    ]
    rows = [np.tile(np.frombuffer(part, np.uint8), (count, 1)) for part in (head, footer)]
    return np.concatenate([rows[0], *body, rows[1]], axis=1)


def _values(layout: Layout, count: int, random: np.random.Generator) -> list[Places]:
    """Legal whole numbers of each field, a row a frame; selectors before what they pick."""
    drawn: dict[int, Places] = {}
    for index, part in sorted(enumerate(layout.fields), key=lambda each: each[1].selector >= 0):
        if part.choices:
            size = (count, len(part.cases[0].numbers))
            drawn[index] = random.choice(np.array(part.choices), size)
        elif part.selector < 0:
            drawn[index] = _drawn(part.cases[0], count, random)
        else:
            drawn[index] = _picked(part.cases, drawn[part.selector][:, 0], random)
    return [drawn[index] for index in range(len(layout.fields))]


def _reply(table: Table, name: str) -> tuple[int, Layout]:
    command = table.command(name)
    return command.id, command.reply[0]


def _mixed(table: Table, forms: Forms, shares: Sequence[float], count: int, seed: int) -> Line:
    random = np.random.default_rng(seed)
    which = random.choice(len(forms), count, p=shares)
    all_sizes = np.array([table.frame.overhead + table.frame.length(f.size) for _, f in forms])
    sizes = all_sizes[which].astype(np.int64)
    ends = np.cumsum(sizes)
    starts = ends - sizes
    data = np.zeros(int(ends[-1]) if count else 0, np.uint8)
    for index, (id, layout) in enumerate(forms):
        places = starts[which == index]
        rows = frames_alike(table, id, layout, len(places), random)
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


def _words(number: Number, wholes: Places) -> Bytes:
    order = range(number.width) if number.order == "little" else range(number.width - 1, -1, -1)
    return np.stack([(wholes >> 8 * place & 0xFF).astype(np.uint8) for place in order], axis=1)
