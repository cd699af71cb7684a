"""The C code agrees with our codec on random messages, values and streams."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import vectors
from cobotwire.codec.interface import Frame, Listening
from cobotwire.protocol.table import Direction
from strategies import (
    TABLES,
    CommandVariant,
    chunked,
    codec_of,
    legal_values,
    near_frames,
    real_frames,
    received,
    streams,
    variants_of,
)
from targets.c.comparison import joined
from targets.c.compiled import missing, program
from targets.c.ours import CodecSide, events
from targets.c.peer import CPeer

pytestmark = pytest.mark.skipif(bool(missing("gcc")), reason=missing("gcc"))
DIRECTIONS: st.SearchStrategy[Direction] = st.sampled_from(["request", "reply"])
# Each test runs for each edition; fuzz.py in this folder runs for longer.
QUICK = settings(max_examples=40)
LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])


@pytest.fixture(scope="module", params=sorted(TABLES))
def edition(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def ours(edition: str) -> CodecSide:
    return CodecSide(vectors.edition(edition), codec_of(edition, "reference"))


@pytest.fixture(scope="module")
def peer(edition: str) -> Iterator[CPeer]:
    with CPeer(program(vectors.edition(edition))) as started:
        yield started


@QUICK
@given(data=st.data())
def test_legal_message_encodes_and_decodes_as_in_codec(
    edition: str, ours: CodecSide, peer: CPeer, data: st.DataObject
) -> None:
    variant = data.draw(st.sampled_from(variants_of(TABLES[edition])))
    values = data.draw(legal_values(variant.variant))
    frame, number = ours.encoded(variant, values), ours.number(variant)
    assert isinstance(frame, bytes)
    found = peer.decode(number, frame)
    assert found == (number, found[1], ours.flat(number, variant.variant, values))
    assert peer.encode(number, found[1]) == frame
    assert peer.encode_values(number, ours.flat(number, variant.variant, values)) == frame
    direction = variant.direction
    assert ours.read_in_c(peer.read(direction, frame)) == ours.read(direction, frame)


def _numbers() -> st.SearchStrategy[float]:
    """Draw numbers between the steps, on their halves, at and beyond the bounds, and NaN."""
    halves = st.integers(-80_000, 80_000).map(lambda steps: steps / 200)
    return st.one_of(st.floats(), st.floats(-400, 400), halves)


@st.composite
def _any_values(draw: st.DrawFn, variant: CommandVariant) -> tuple[Any, ...]:
    """Draw legal values, some replaced by a real number (with a scale) or by an integer."""

    def other(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(map(other, value))
        if draw(st.integers(0, 3)):
            return value
        if isinstance(value, float):
            return draw(_numbers())
        return draw(st.integers(-70_000, 70_000))

    fields = variant.variant.fields
    return tuple(
        value if field.choices and len(field.choices) == 1 else other(value)
        for field, value in zip(fields, draw(legal_values(variant.variant)))
    )


@QUICK
@given(data=st.data())
def test_any_value_is_encoded_or_rejected_as_in_codec(
    edition: str, ours: CodecSide, peer: CPeer, data: st.DataObject
) -> None:
    variant = data.draw(
        st.sampled_from(variants_of(TABLES[edition])).filter(lambda f: f.variant.fields)
    )
    values = data.draw(_any_values(variant))
    number = ours.number(variant)
    numbers = ours.flat(number, variant.variant, values)
    found = ours.rejected_in_c(peer.encode_values(number, numbers))
    assert found == ours.encoded(variant, values)


@pytest.mark.parametrize("eighths", [1, 3, 5, 7, -1, -3, -5, -7])
def test_half_a_step_rounds_to_even(
    edition: str, ours: CodecSide, peer: CPeer, eighths: int
) -> None:
    # Only eighths lie exactly between two hundredths.
    variant = next(
        variant for variant in variants_of(TABLES[edition]) if variant.command.name == "send_angle"
    )
    values = (1, eighths / 8, 20)
    number = ours.number(variant)
    numbers = ours.flat(number, variant.variant, values)
    assert peer.encode_values(number, numbers) == ours.encoded(variant, values)


@QUICK
@given(data=st.data())
def test_any_bytes_are_decoded_or_rejected_as_in_codec(
    edition: str, ours: CodecSide, peer: CPeer, data: st.DataObject
) -> None:
    table = TABLES[edition]
    direction = data.draw(DIRECTIONS)
    frame = bytearray(
        data.draw(real_frames(table) | near_frames(table) | _near_values(variant_bytes))
    )
    for place in data.draw(st.lists(st.integers(0, 40), max_size=2)):
        if place < len(frame):
            frame[place] = data.draw(st.integers(0, 255))
    cut = bytes(frame[: data.draw(st.integers(0, 60))])
    assert ours.read_in_c(peer.read(direction, cut)) == ours.read(direction, cut)


def _near_values(make: Any) -> st.SearchStrategy[bytes]:
    return st.sampled_from(variants_of(TABLES["mycobot280"])).flatmap(make)


def variant_bytes(variant: CommandVariant) -> st.SearchStrategy[bytes]:
    """Draw a whole frame of a variant with any data."""
    frame = TABLES["mycobot280"].frame
    head = frame.header + bytes([frame.length(variant.variant.size), variant.command.id])
    size = variant.variant.size
    return st.binary(min_size=size, max_size=size).map(lambda data: head + data + frame.footer)


def test_ambiguous_frame_decodes_as_first_command(
    edition: str, ours: CodecSide, peer: CPeer
) -> None:
    table = TABLES[edition]
    lengths = Counter((variant.command.id, variant.variant.size) for variant in variants_of(table))
    shared = sorted(key for key, count in lengths.items() if count > 1 and key[1])
    assert shared
    for id, size in shared:
        head = table.frame.header + bytes([table.frame.length(size), id])
        for fill in (0, 1, 2, 7, 23, 64, 101, 128, 200, 255):
            frame = head + bytes([fill] * size) + table.frame.footer
            (event,) = ours.codec.framer("both").feed(frame)
            assert isinstance(event, Frame)
            assert ours.read_in_c(peer.read("both", frame)) == ours.event(event)
            for way in ("request", "reply"):
                assert ours.read_in_c(peer.read(way, frame)) == ours.read(way, frame)


@QUICK
@given(data=st.data())
def test_frame_decodes_as_a_named_message_or_is_rejected_as_in_codec(
    edition: str, ours: CodecSide, peer: CPeer, data: st.DataObject
) -> None:
    variants = variants_of(TABLES[edition])
    alone = [
        variant for variant in variants if len(variant.command.variants(variant.direction)) == 1
    ]
    variant = data.draw(st.sampled_from(alone))
    frame = data.draw(variant_bytes(variant) | real_frames(TABLES[edition]))
    found = ours.read_in_c(peer.decode(ours.number(variant), frame))
    assert found == ours.read(variant.direction, frame, variant.command.name)


@QUICK
@given(data=st.data())
def test_stream_in_any_chunks_is_framed_as_in_codec(
    edition: str, ours: CodecSide, peer: CPeer, data: st.DataObject
) -> None:
    table, listening = TABLES[edition], data.draw(LISTENING)
    unknown = data.draw(st.booleans())
    lines = received(table, listening).map(lambda line: line.data)
    chunks = data.draw(chunked(data.draw(streams(table) | lines)))
    flushes = [data.draw(st.integers(0, 4)) == 0 for _ in chunks]
    framer = ours.codec.framer(listening, accept_unknown=unknown)
    right = []
    for chunk, flush in zip(chunks, flushes):
        right += framer.feed(chunk) + (framer.flush() if flush else [])
    found, pending = peer.events(listening, list(zip(chunks, flushes)), unknown)
    assert joined(found) == joined(list(events(right)))
    assert pending == framer.pending
    for event in right if not unknown else []:
        if isinstance(event, Frame):
            assert ours.read_in_c(peer.read(listening, event.data)) == ours.event(event)


@pytest.mark.parametrize("longer", [-1, 0, 1])
def test_frame_of_unknown_id_is_limited_to_the_longest_length(
    edition: str, ours: CodecSide, peer: CPeer, longer: int
) -> None:
    table = TABLES[edition]
    unknown = min(set(range(256)) - {command.id for command in table.commands})
    length = table.frame.maximum_length + longer
    size = length - table.frame.length(0)
    stream = table.frame.header + bytes([length, unknown]) + bytes(size) + table.frame.footer
    framer = ours.codec.framer("both", accept_unknown=True)
    right = list(events(framer.feed(stream) + framer.flush()))
    assert right[0].reason == ("bad-length" if longer > 0 else "ok")
    found, _ = peer.events("both", [(stream, True)], True)
    assert joined(found) == joined(right)


def test_names_in_c_equal_the_names_in_the_spec(ours: CodecSide, peer: CPeer) -> None:
    assert peer.names() == [
        [message.command.name, *(member.field.name for member in message.members)]
        for message in ours.messages
    ]


def test_too_small_buffer_is_rejected_and_not_overrun(
    edition: str, ours: CodecSide, peer: CPeer
) -> None:
    for number, message in enumerate(ours.messages):
        size = message.size + 5
        raw_values = [0] * message.count
        short = peer.encode(number, raw_values, room=size - 1)
        assert not isinstance(short, bytes)
        assert short.status == "no-room"
        enough = peer.encode(number, raw_values, room=size)
        assert isinstance(enough, bytes) or enough.status == "bad-value"
