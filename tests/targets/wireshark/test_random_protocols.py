"""A dissector generated from a random protocol reads its messages."""

from __future__ import annotations

import itertools
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import random_specs
from cobotwire import codec as codecs
from cobotwire.codec.interface import Listening
from cobotwire_codegen import lower
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.targets.wireshark import render_wireshark
from json_tables import table_of
from strategies import chunked
from targets.wireshark.comparison import Line, compared
from targets.wireshark.dissecting import needs_tshark

pytestmark = needs_tshark
NUMBERS = itertools.count()


@settings(max_examples=5, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_random_protocol_is_dissected(tmp_path: Path, data: st.DataObject) -> None:
    _, edition = data.draw(random_specs.specs(tmp_path, f"rnd{next(NUMBERS)}", plain=True))
    check(edition)
    write(Target(tmp_path / edition.name, render_wireshark([edition])))
    frames = [vector.frame or b"" for vector in edition.vectors]
    lines = [
        Line(vector.name, vector.direction, [frame])
        for vector, frame in zip(edition.vectors, frames)
    ]
    cut = st.sampled_from(frames).flatmap(
        lambda frame: st.integers(0, len(frame)).map(lambda end: frame[:end])
    )
    pieces = st.sampled_from(frames) | cut | st.binary(min_size=1, max_size=9)
    for _ in range(10):
        stream = b"".join(data.draw(st.lists(pieces, min_size=1, max_size=9)))
        chunks = [chunk for chunk in data.draw(chunked(stream)) if chunk]
        ways: list[Listening] = ["request", "reply", "both"]
        direction = data.draw(st.sampled_from(ways))
        lines.append(Line(stream.hex(" "), direction, chunks))
    codec = codecs.load(table_of(lower.table(edition)), "reference")
    script = tmp_path / edition.name / f"{edition.name}.lua"
    found = compared([line for line in lines if line.chunks], codec, [script])
    assert found.differences == []
