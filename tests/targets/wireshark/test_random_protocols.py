"""Dissectors generated from random protocols and random frame formats read their messages."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import get_args

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import random_specs
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Listening
from cobotwire.protocol.loading import table_of
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.model import Edition
from cobotwire_codegen.publish import edition_json
from cobotwire_codegen.targets.wireshark import render_wireshark
from random_editions import sensors
from strategies import chunked
from targets.wireshark.comparison import Line, all_compared
from targets.wireshark.dissecting import needs_tshark

pytestmark = needs_tshark
NUMBERS = itertools.count()
# One run of tshark reads several protocols. Shrinking would run it for minutes. The first example
# is always the simplest one.
FEW = settings(
    max_examples=2, phases=[Phase.reuse, Phase.generate], suppress_health_check=list(HealthCheck)
)


@st.composite
def lines(draw: st.DrawFn, edition: Edition) -> list[Line]:
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
        direction: Listening = draw(st.sampled_from(get_args(Listening)))
        found.append(Line(stream.hex(" "), direction, chunks))
    return [line for line in found if line.chunks]


def codec_of(edition: Edition) -> Codec:
    return codecs.load(table_of(json.loads(edition_json(edition))), "reference")


def agree(editions: list[Edition], folder: Path, draw: Callable[[Edition], list[Line]]) -> None:
    """Check that the dissectors show what the codecs read."""
    write(Target(folder / editions[0].name, render_wireshark(editions)))
    scripts = [folder / editions[0].name / f"{edition.name}.lua" for edition in editions]
    parts = [(draw(edition), codec_of(edition)) for edition in editions]
    found = all_compared(parts, scripts)
    assert found.differences == [], "\n".join(found.differences)


@FEW
@given(data=st.data())
def test_random_protocols_are_dissected(tmp_path: Path, data: st.DataObject) -> None:
    editions = []
    for _ in range(2):
        _, edition = data.draw(random_specs.specs(tmp_path, f"rnd{next(NUMBERS)}"))
        check(edition)
        editions.append(edition)
    agree(editions, tmp_path, lambda edition: data.draw(lines(edition)))


@FEW
@given(data=st.data())
def test_random_frame_formats_are_dissected(tmp_path: Path, data: st.DataObject) -> None:
    editions = [data.draw(sensors(f"format{next(NUMBERS)}")) for _ in range(10)]
    agree(editions, tmp_path, lambda edition: data.draw(lines(edition)))
