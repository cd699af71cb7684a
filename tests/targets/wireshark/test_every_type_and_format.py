"""Dissectors of other protocols, with every type and in random frames, agree with the codec."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import get_args

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import random_specs
import vectors
from cobotwire.codec.interface import Listening
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.model import Edition
from cobotwire_codegen.targets.wireshark import render_wireshark
from random_editions import sensors
from strategies import DIRECTIONS, chunked
from targets.expected import codec_of_edition
from targets.specs import SPECS, edition_of
from targets.wireshark.comparison import Line, all_compared
from targets.wireshark.dissecting import needs_tshark

pytestmark = needs_tshark
NUMBERS = itertools.count()
LISTENING: tuple[Listening, ...] = get_args(Listening)


def lines_of(edition: Edition) -> Iterator[Line]:
    """Return lines with each vector, whole, damaged and in pieces, and with all of a direction."""
    for vector in edition.vectors:
        if frame := vector.frame:
            broken = frame[:-1] + bytes([frame[-1] ^ 1])
            pieces = [frame[at : at + 5] for at in range(0, len(frame), 5)]
            yield Line(vector.name, vector.direction, [frame])
            yield Line(f"{vector.name}, damaged, whole", vector.direction, [broken + frame])
            yield Line(f"{vector.name}, in pieces", "both", pieces)
    for direction in DIRECTIONS:
        own = (each.frame for each in edition.vectors if each.direction == direction)
        noisy = [frame + b"\xff" for frame in own if frame]
        yield Line(f"every {direction} with noise between", direction, noisy)


@st.composite
def drawn_lines(draw: st.DrawFn, edition: Edition) -> list[Line]:
    """Draw lines with frames of an edition, whole and cut, and other bytes between them."""
    frames = [vector.frame or b"" for vector in edition.vectors]
    found = [
        Line(vector.name, vector.direction, [frame])
        for vector, frame in zip(edition.vectors, frames)
    ]
    cut = st.sampled_from(frames).flatmap(
        lambda frame: st.integers(0, len(frame)).map(lambda end: frame[:end])
    )
    pieces = st.sampled_from(frames) | cut | st.binary(min_size=1, max_size=9)
    for _ in range(4):
        stream = b"".join(draw(st.lists(pieces, min_size=1, max_size=9)))
        chunks = [chunk for chunk in draw(chunked(stream)) if chunk]
        found.append(Line(stream.hex(" "), draw(st.sampled_from(LISTENING)), chunks))
    return [line for line in found if line.chunks]


def agree(parts: list[tuple[Edition, list[Line]]], folder: Path) -> None:
    """Check that the dissectors show what the codecs read."""
    editions = [edition for edition, _ in parts]
    write(Target(folder / "lua", render_wireshark(editions)))
    scripts = [folder / "lua" / f"{edition.name}.lua" for edition in editions]
    known = [(lines, codec_of_edition(edition)) for edition, lines in parts]
    found = all_compared(known, scripts)
    assert found.differences == [], "\n".join(found.differences)
    assert found.fields > 100


def test_other_protocols_are_dissected(tmp_path: Path) -> None:
    editions = [edition_of(name) for name in SPECS]
    agree([(edition, list(lines_of(edition))) for edition in editions], tmp_path)


def test_shipped_editions_are_dissected(tmp_path: Path) -> None:
    """Read a part of the vectors; the two editions with the most commands have other tests."""
    editions = [vectors.edition(name) for name in vectors.further()]
    assert len(editions) > 5
    few = [replace(each, vectors=each.vectors[::8]) for each in editions]
    agree([(edition, list(lines_of(edition))) for edition in few], tmp_path)


# One run of tshark reads several protocols. Shrinking would run it for minutes. The first example
# is always the simplest one.
@settings(
    max_examples=2, phases=[Phase.reuse, Phase.generate], suppress_health_check=list(HealthCheck)
)
@given(data=st.data())
def test_random_protocols_and_frame_formats_are_dissected(
    tmp_path: Path, data: st.DataObject
) -> None:
    number = next(NUMBERS)
    editions = [data.draw(sensors(f"format{number}x{index}")) for index in range(8)]
    for index in range(2):
        _, edition = data.draw(random_specs.specs(tmp_path, f"rnd{number}x{index}"))
        check(edition)
        editions.append(edition)
    folder = tmp_path / str(number)
    agree([(edition, data.draw(drawn_lines(edition))) for edition in editions], folder)
