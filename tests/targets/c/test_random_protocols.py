"""C code generated from a random protocol reads, builds and frames its messages."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import random_specs
from cobotwire import codec as codecs
from cobotwire.codec.interface import Listening
from cobotwire.protocol.table import Direction
from cobotwire_codegen import lower
from cobotwire_codegen.check import check
from json_tables import table_of
from strategies import CommandVariant, chunked
from targets.c.comparison import joined
from targets.c.compiled import missing, program
from targets.c.ours import CodecSide, events
from targets.c.peer import CPeer, Read

pytestmark = pytest.mark.skipif(bool(missing("gcc")), reason=missing("gcc"))
NUMBERS = itertools.count()
DIRECTIONS: st.SearchStrategy[Direction] = st.sampled_from(["request", "reply"])
LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])


@settings(max_examples=5, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_random_protocol_runs_in_c(tmp_path: Path, data: st.DataObject) -> None:
    _, edition = data.draw(random_specs.specs(tmp_path, f"rnd{next(NUMBERS)}", plain=True))
    check(edition)
    table = table_of(lower.table(edition))
    ours = CodecSide(edition, codecs.load(table, "reference"))
    address = table.frame.addresses[0] if table.frame.addresses else 0
    frames = [vector.frame or b"" for vector in edition.vectors]
    with CPeer(program(edition)) as peer:
        for vector, frame in zip(edition.vectors, frames):
            message = ours.codec.decode(vector.direction, frame)
            variants = message.command.variants(vector.direction)
            number = next(i for i, variant in enumerate(variants) if variant is message.variant)
            index = ours.number(
                CommandVariant(message.command, vector.direction, message.variant, number)
            )
            found = peer.decode(index, frame)
            assert isinstance(found, Read)
            assert found == ours.read(vector.direction, frame)
            assert peer.encode(index, found.raw_values, address) == frame
            assert peer.encode_values(index, ours.flat(index, message.values), address) == frame
        for _ in range(8):
            _any_bytes(data, frames, ours, peer)
            _any_stream(data, frames, ours, peer)


def _any_bytes(data: st.DataObject, frames: list[bytes], ours: CodecSide, peer: CPeer) -> None:
    frame = bytearray(data.draw(st.sampled_from(frames)))
    for place in data.draw(st.lists(st.integers(0, len(frame) - 1), max_size=2)):
        frame[place] = data.draw(st.integers(0, 255))
    cut = bytes(frame[: data.draw(st.integers(0, 90))])
    direction = data.draw(DIRECTIONS)
    assert ours.read_in_c(peer.read(direction, cut)) == ours.read(direction, cut)


def _any_stream(data: st.DataObject, frames: list[bytes], ours: CodecSide, peer: CPeer) -> None:
    pieces = st.sampled_from(frames) | st.binary(max_size=9)
    cut = st.sampled_from(frames).flatmap(
        lambda frame: st.integers(0, len(frame)).map(lambda end: frame[:end])
    )
    stream = b"".join(data.draw(st.lists(pieces | cut, max_size=9)))
    listening = data.draw(LISTENING)
    framer = ours.codec.framer(listening)
    chunks = data.draw(chunked(stream))
    right = [event for chunk in chunks for event in framer.feed(chunk)] + framer.flush()
    found, _ = peer.events(listening, [*((chunk, False) for chunk in chunks), (b"", True)])
    assert joined(found) == joined(list(events(right)))
