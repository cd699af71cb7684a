"""The framing laws and the agreement of both codecs, in the maker's formats and random ones."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

import random_tables
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame, Listening
from cobotwire.protocol.errors import CobotwireError
from cobotwire.protocol.table import Direction, Table
from frame_format_tables import ALIKE, CRC, HEADER, SUM
from framed_events import cut, joined

TABLES = [CRC, SUM, ALIKE]
FIXED: st.SearchStrategy[tuple[Codec, Codec]] = st.sampled_from(
    [(codecs.load(table, "reference"), codecs.load(table, "native")) for table in TABLES]
)
WAYS: list[Direction] = ["request", "reply"]
DIRECTIONS: st.SearchStrategy[Direction] = st.sampled_from(["request", "reply"])
LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])


@st.composite
def _pairs(draw: st.DrawFn) -> tuple[Codec, Codec]:
    table = draw(random_tables.tables())
    return codecs.load(table, "reference"), codecs.load(table, "native")


PAIRS = FIXED | _pairs()


@st.composite
def _frames(draw: st.DrawFn, table: Table, *, damaged: bool = False) -> bytes:
    """Draw a legal frame with any values; with ``damaged``, one or two bytes may be changed."""
    variants = [
        (command.id, direction, variant)
        for command in table.commands
        for direction in WAYS
        for variant in command.variants(direction)
    ]
    id, direction, variant = draw(st.sampled_from(variants))
    data = draw(st.binary(min_size=variant.size, max_size=variant.size))
    address = draw(st.sampled_from(table.frame.addresses or [None]))
    whole = bytearray(table.frame.enclose(id, data, address, direction))
    for place in draw(st.lists(st.integers(0, len(whole) - 1), max_size=2)) if damaged else ():
        whole[place] = draw(st.integers(0, 255))
    return bytes(whole)


def _noise() -> st.SearchStrategy[bytes]:
    starts = st.sampled_from([HEADER, b"\xfe", b"\xfe\xfe\x04", b"\xfe\xfe\x01\x0e\x20"])
    return st.one_of(starts, st.binary(max_size=8), strategies.line_noise())


def _streams(table: Table) -> st.SearchStrategy[bytes]:
    pieces = st.one_of(_frames(table), _frames(table, damaged=True), _noise())
    return st.lists(pieces, max_size=8).map(b"".join)


def _outcome(action: Callable[[], Any]) -> Any:
    try:
        return action()
    except CobotwireError as error:
        return type(error), str(error), repr(vars(error))


@given(PAIRS, LISTENING, st.booleans(), st.data())
def test_both_framers_return_the_same_events(
    pair: tuple[Codec, Codec], listening: Listening, accept_unknown: bool, data: st.DataObject
) -> None:
    stream = data.draw(_streams(pair[0].table))
    framers = [codec.framer(listening, accept_unknown=accept_unknown) for codec in pair]
    for chunk in data.draw(strategies.chunked(stream)):
        assert framers[0].feed(chunk) == framers[1].feed(chunk)
        assert framers[0].pending == framers[1].pending
    assert framers[0].flush() == framers[1].flush()


@given(PAIRS, DIRECTIONS, st.data())
def test_both_codecs_decode_a_message_alike_or_reject_it_at_the_same_byte(
    pair: tuple[Codec, Codec], direction: Direction, data: st.DataObject
) -> None:
    table = pair[0].table
    frame = data.draw(_frames(table) | _frames(table, damaged=True))
    frame = frame[: data.draw(st.integers(0, len(frame)) | st.just(len(frame)))]
    of = data.draw(st.none() | st.sampled_from([command.name for command in table.commands]))
    reference, native = (
        _outcome(lambda codec=codec: codec.decode(direction, frame, of=of))  # type: ignore[misc]
        for codec in pair
    )
    assert reference == native


@given(PAIRS, DIRECTIONS, st.data())
def test_both_codecs_encode_a_frame_alike_or_reject_it_with_the_same_message(
    pair: tuple[Codec, Codec], direction: Direction, data: st.DataObject
) -> None:
    command = data.draw(st.sampled_from(pair[0].table.commands))
    number = st.integers(-5, 40) | st.floats(-400, 400)
    values = data.draw(st.lists(number | st.lists(number, min_size=6, max_size=6), max_size=2))
    variant = data.draw(st.none() | st.integers(-1, 2))
    address = data.draw(st.none() | st.integers(-1, 4))
    reference, native = (
        _outcome(
            lambda codec=codec: codec.encode(  # type: ignore[misc]
                command.name, direction, values, variant=variant, address=address
            )
        )
        for codec in pair
    )
    assert reference == native


@given(PAIRS, LISTENING, st.data())
def test_every_byte_is_in_one_event_for_any_chunking(
    pair: tuple[Codec, Codec], listening: Listening, data: st.DataObject
) -> None:
    stream = data.draw(_streams(pair[0].table))
    chunks = data.draw(strategies.chunked(stream))
    for codec in pair:
        events = joined(cut(codec, listening, chunks))
        assert b"".join(event.data for event in events) == stream
        assert all(a.offset + len(a.data) == b.offset for a, b in pairwise(events))
        assert events == joined(cut(codec, listening, [stream]))


@given(PAIRS, st.data())
def test_undamaged_frame_is_found_unless_a_legal_one_covers_it(
    pair: tuple[Codec, Codec], data: st.DataObject
) -> None:
    table = pair[0].table
    before, frame = data.draw(_streams(table)), data.draw(_frames(table))
    chunks = [before, frame, data.draw(_noise())]
    start = len(before)
    for codec in pair:
        events = joined(cut(codec, "both", chunks))
        if Frame(start, frame, table.frame.read_id(frame)) not in events:
            covers = [e for e in events if isinstance(e, Frame) and e.offset < start]
            assert covers[-1].offset + len(covers[-1].data) > start
