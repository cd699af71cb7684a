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
from cobotwire.simulator.faults.noise import COMMAND_ERROR, PANIC
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


@pytest.mark.parametrize(
    ("stream", "reason"),
    [
        ("00", "no-header"),
        ("FE 00 00", "no-header"),
        ("FE FE 77 20 FA", "bad-length"),
        ("FE FE 03 20 01 FA", "bad-length"),
        ("FE FE 03 99 01 FA", "unknown-id"),
        ("FE FE 03 12 01 FB", "bad-check"),
        ("FE FE 03 12", "truncated"),
        ("FE", "truncated"),
    ],
)
def test_first_byte_of_noise_has_the_reason(codec: Codec, stream: str, reason: str) -> None:
    first = cut(codec, "reply", [bytes.fromhex(stream)])[0]
    assert isinstance(first, Noise)
    assert first.reason == reason


ANGLES = bytes.fromhex("FE FE 0E 20 00 00 01 02 03 04 05 06 07 08 09 0A FA")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")


@pytest.mark.parametrize(
    "noise",
    [
        "ff ff 01 04 02 38 02 be",
        "ff ff 01 04 00 ff 07 f4",
        "ff ff fe 0a 82 38 0f 01 02 03 04 05 06 19",
        "ff ff 07 02 01 f5",
        "ff ff 01 04 02 38 c2 fe",  # its checksum is FE
        "fe fe 03 10 01 fa",  # this edition has no acknowledgements
        "78 80 78",
        "fe",
        "fe fe fe",
        "fe fe 0e",
        "fe fe 0e 99",
        "fe fe 77 20",
        "fe fe fe 0e",
        bytes(277).hex(),
        COMMAND_ERROR.hex(),
        PANIC.hex(),
        PANIC[PANIC.index(b"Backtrace") :].hex(),
    ],
)
def test_noise_seen_in_the_field_hides_no_frame(codec: Codec, noise: str) -> None:
    piece = bytes.fromhex(noise)
    stream, sent = b"", []
    for frame in [ANGLES, POWERED] * 3:
        stream += piece
        sent.append((len(stream), frame))
        stream += frame
    for chunks in ([stream], [bytes([byte]) for byte in stream]):
        events = cut(codec, "reply", chunks)
        assert [(e.offset, e.data) for e in events if isinstance(e, Frame)] == sent


@pytest.mark.parametrize(
    ("text", "inside"),
    [
        # By chance an FA is where the frame of a false header would end: that frame is legal.
        ("FE FE 0E 20 FE FE 03 12 01 FA FE FE 03 53 87 FA FA", [4, 10]),
        ("FE FE 0E 20 00 00 FE FE 03 12 01 FA 00 00 00 00 FA", [6]),
    ],
)
def test_frames_within_a_legal_frame_are_found_only_if_it_is_damaged(
    codec: Codec, text: str, inside: list[int]
) -> None:
    whole = bytes.fromhex(text)
    assert cut(codec, "reply", [whole]) == [Frame(0, whole, 0x20)]
    events = cut(codec, "reply", [whole[:-1] + b"\x00"])
    assert [e.offset for e in events if isinstance(e, Frame)] == inside


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
