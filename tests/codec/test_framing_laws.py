"""The framing laws, as properties of both codecs, and the streams that showed the need for them.

Every frame sent is known. The tests decide by the table, without a codec, which frames are legal.
"""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

import random_tables
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.table import Table
from framed_events import cut, joined
from strategies import TABLES, codec_of

KNOWN = [*TABLES.values(), *random_tables.FORMATS]
LISTENING: st.SearchStrategy[Listening] = st.sampled_from(["request", "reply", "both"])
EACH_CODEC = pytest.mark.parametrize("name", strategies.CODECS)


def _legal(table: Table, listening: Listening, data: bytes) -> bool:
    """Return whether the bytes are a legal frame of the table."""
    for command in table.commands:
        for direction in strategies.DIRECTIONS:
            for variant in command.variants(direction) if listening in (direction, "both") else ():
                address = table.frame.address(data)
                start = table.frame.data_start(direction)
                content = data[start : start + variant.size]
                if data == table.frame.enclose(command.id, content, address, direction):
                    return True
    return False


def _covered(events: list[Event], start: int, frame: bytes) -> bool:
    """Return whether a frame was found, or another one covers its start."""
    frames = [event for event in events if isinstance(event, Frame)]
    return any(
        (each.offset, each.data) == (start, frame)
        or each.offset < start < each.offset + len(each.data)
        for each in frames
    )


@EACH_CODEC
@given(random_tables.any_tables(), LISTENING, st.booleans(), st.data())
def test_every_byte_is_in_exactly_one_event_for_any_chunking(
    name: codecs.CodecName, table: Table, listening: Listening, unknown: bool, data: st.DataObject
) -> None:
    stream = data.draw(random_tables.any_streams(table))
    framer = codecs.load(table, name).framer(listening, accept_unknown=unknown)
    # LEN of a random table may be above its stated maximum.
    sizes = [table.frame.length(v.variant.size, v.direction) for v in strategies.variants_of(table)]
    longest = max(table.frame.maximum_length, *sizes) + table.frame.overhead
    fed = 0
    events: list[Event] = []
    for chunk in data.draw(strategies.chunked(stream)):
        events += framer.feed(chunk)
        fed += len(chunk)
        assert sum(len(event.data) for event in events) + framer.pending == fed
        assert framer.pending < longest
    events += framer.flush()
    assert framer.pending == 0
    assert b"".join(event.data for event in events) == stream
    assert all(a.offset + len(a.data) == b.offset for a, b in pairwise(events))
    assert not events or events[0].offset == 0
    whole = codecs.load(table, name).framer(listening, accept_unknown=unknown)
    assert joined(events) == joined(whole.feed(stream) + whole.flush())


@EACH_CODEC
@given(st.sampled_from(KNOWN), LISTENING, st.data())
def test_only_legal_frames_are_found_and_an_undamaged_one_is_found_unless_covered(
    name: codecs.CodecName, table: Table, listening: Listening, data: st.DataObject
) -> None:
    line = data.draw(strategies.received(table, listening))
    events = cut(codecs.load(table, name), listening, [line.data])
    for start, frame in line.whole:
        assert _covered(events, start, frame), f"the frame at {start} is lost"
    for event in events:
        if isinstance(event, Frame):
            assert _legal(table, listening, event.data)
            assert event.command == table.frame.read_id(event.data)


@EACH_CODEC
@given(random_tables.tables(), st.data())
def test_undamaged_frame_of_a_random_table_is_found_unless_a_legal_one_covers_it(
    name: codecs.CodecName, table: Table, data: st.DataObject
) -> None:
    before = data.draw(random_tables.streams(table) | strategies.line_noise())
    frame = data.draw(random_tables.frames(table, unknown=False))
    after = data.draw(strategies.line_noise())
    events = cut(codecs.load(table, name), "both", [before, frame, after])
    assert _covered(events, len(before), frame)


@EACH_CODEC
@given(st.sampled_from(sorted(TABLES)), st.integers(0, 40), st.integers(1, 40), st.data())
def test_header_bytes_and_adjacent_frames_hide_no_frame(
    name: codecs.CodecName, edition: str, count: int, times: int, data: st.DataObject
) -> None:
    # FE is not a legal LEN, so FE FE FE is rejected at its first byte.
    frame = data.draw(strategies.real_frames(TABLES[edition]))
    events = cut(codec_of(edition, name), "both", [b"\xfe" * count + frame * times])
    found = [event for event in events if isinstance(event, Frame)]
    assert found == [Frame(count + n * len(frame), frame, frame[3]) for n in range(times)]
    assert {e.reason for e in events if isinstance(e, Noise)} == (
        {"bad-length"} if count else set()
    )


POWERED = bytes.fromhex("FE FE 03 12 01 FA")


@pytest.mark.parametrize("false", ["FE FE 0D 20", "FE FE 0E 12"])
def test_header_with_a_length_that_its_id_lacks_does_not_make_the_framer_wait(
    codec: Codec, false: str
) -> None:
    events = codec.framer("reply").feed(bytes.fromhex(false) + POWERED)
    assert Frame(4, POWERED, 0x12) in events


def test_frame_after_a_false_header_is_returned_by_flush(codec: Codec) -> None:
    framer = codec.framer("reply")
    assert framer.feed(bytes.fromhex("FE FE 0E 20") + POWERED) == []
    assert Frame(4, POWERED, 0x12) in framer.flush()


@pytest.mark.parametrize("size", [0, 2, TABLE.frame.maximum_length - 2])
def test_unknown_id_is_accepted_on_request(codec: Codec, size: int) -> None:
    assert 0xE0 not in {command.id for command in TABLE.commands}
    frame = TABLE.frame.enclose(0xE0, bytes(size), None, "reply")
    assert all(isinstance(event, Noise) for event in codec.framer("reply").feed(frame))
    assert codec.framer("reply", accept_unknown=True).feed(frame) == [Frame(0, frame, 0xE0)]
