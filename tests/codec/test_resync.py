"""The three laws of resync on realistic bad lines, where every frame sent is known.

These tests decide by the table, without a codec, which frames are legal.
"""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

import strategies
from cobotwire.codec import CodecName
from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.table import Table
from cobotwire.simulator.faults.noise import COMMAND_ERROR, PANIC
from framed_events import cut
from strategies import TABLES, codec_of

EACH_CODEC = pytest.mark.parametrize("name", ["reference", "native"])
EDITIONS = st.sampled_from(sorted(TABLES))
LISTENING = st.sampled_from(["request", "reply", "both"])


def _byte_by_byte(events: list[Event]) -> list[object]:
    """Return frames, and the reason of each byte of noise, so that spans may be cut anywhere."""
    pieces: list[object] = []
    for event in events:
        if isinstance(event, Noise):
            pieces += [(event.offset + at, event.reason) for at in range(len(event.data))]
        else:
            pieces.append((event.offset, event.data, event.command))
    return pieces


def _legal(table: Table, listening: Listening, data: bytes) -> bool:
    sizes = {
        (command.id, table.frame.length(variant.size))
        for command in table.commands
        for direction in ("request", "reply")
        for variant in command.variants(direction)
        if listening in (direction, "both")
    }
    size = 3 + data[2]
    return (
        data[:2] == b"\xfe\xfe"
        and (data[3], data[2]) in sizes
        and len(data) == size
        and data[-1:] == b"\xfa"
    )


@EACH_CODEC
@given(EDITIONS, LISTENING, st.data())
def test_undamaged_frame_is_recovered_unless_a_legal_false_one_covers_it(
    name: CodecName, edition: str, listening: Listening, data: st.DataObject
) -> None:
    table = TABLES[edition]
    line = data.draw(strategies.received(table, listening))
    events = cut(codec_of(edition, name), listening, [line.data])
    frames = [event for event in events if isinstance(event, Frame)]
    found = {(frame.offset, bytes(frame.data)) for frame in frames}
    for start, sent in line.whole:
        if (start, sent) not in found:
            over = [f for f in frames if f.offset < start < f.offset + len(f.data)]
            assert over, f"the frame at {start} is lost, and no frame covers it"
            assert _legal(table, listening, over[0].data)


@EACH_CODEC
@given(EDITIONS, LISTENING, st.data())
def test_accepted_frame_is_legal_and_is_part_of_the_stream(
    name: CodecName, edition: str, listening: Listening, data: st.DataObject
) -> None:
    line = data.draw(strategies.received(TABLES[edition], listening))
    for event in cut(codec_of(edition, name), listening, [line.data]):
        assert line.data[event.offset : event.offset + len(event.data)] == event.data
        if isinstance(event, Frame):
            assert _legal(TABLES[edition], listening, event.data)
            assert event.command == event.data[3]


@EACH_CODEC
@given(EDITIONS, LISTENING, st.data())
def test_every_byte_of_a_bad_line_is_in_exactly_one_event(
    name: CodecName, edition: str, listening: Listening, data: st.DataObject
) -> None:
    line = data.draw(strategies.received(TABLES[edition], listening))
    events = cut(codec_of(edition, name), listening, data.draw(strategies.chunked(line.data)))
    assert b"".join(event.data for event in events) == line.data
    assert all(a.offset + len(a.data) == b.offset for a, b in pairwise(events))


@given(EDITIONS, LISTENING, st.data())
def test_both_codecs_return_the_same_events_in_any_chunks(
    edition: str, listening: Listening, data: st.DataObject
) -> None:
    line = data.draw(strategies.received(TABLES[edition], listening))
    chunks = data.draw(strategies.chunked(line.data))
    whole = _byte_by_byte(cut(codec_of(edition, "reference"), listening, [line.data]))
    for name in ("reference", "native"):
        assert _byte_by_byte(cut(codec_of(edition, name), listening, chunks)) == whole


@EACH_CODEC
@given(EDITIONS, st.data())
def test_header_bytes_before_a_frame_do_not_hide_it(
    name: CodecName, edition: str, data: st.DataObject
) -> None:
    # FE is not a legal LEN, so FE FE FE is refuted at its first byte.
    count = data.draw(st.integers(1, 40))
    frame = data.draw(strategies.real_frames(TABLES[edition]))
    events = cut(codec_of(edition, name), "both", [b"\xfe" * count + frame])
    assert events[-1] == Frame(count, frame, frame[3])
    assert {event.reason for event in events[:-1] if isinstance(event, Noise)} == {"bad-length"}


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


def test_false_frame_that_the_table_allows_hides_the_frames_inside_it(codec: Codec) -> None:
    # A header of get_angles, and an FA where that frame would end: the frame is false but legal.
    whole = bytes.fromhex("FE FE 0E 20 FE FE 03 12 01 FA FE FE 03 53 87 FA FA")
    assert cut(codec, "reply", [whole]) == [Frame(0, whole, 0x20)]
    # With one byte less it is refuted, and both frames inside it are found.
    events = cut(codec, "reply", [whole[:-1] + b"\x00"])
    assert [e.offset for e in events if isinstance(e, Frame)] == [4, 10]


def test_frame_within_a_frame_is_found_only_if_the_outer_one_is_damaged(codec: Codec) -> None:
    outer = bytes.fromhex("FE FE 0E 20 00 00 FE FE 03 12 01 FA 00 00 00 00 FA")
    assert cut(codec, "reply", [outer]) == [Frame(0, outer, 0x20)]
    broken = outer[:-1] + b"\xfb"
    found = [e for e in cut(codec, "reply", [broken]) if isinstance(e, Frame)]
    assert found == [Frame(6, broken[6:12], 0x12)]


def test_header_and_known_id_with_a_wrong_length_do_not_make_the_framer_wait(codec: Codec) -> None:
    assert TABLE.command("get_angles").id == 0x20
    line = bytes.fromhex("FE FE 0D 20") + POWERED
    framer = codec.framer("reply")
    events = framer.feed(line)
    assert Frame(4, POWERED, 0x12) in events, "refuted by LEN at once, so nothing waits"
