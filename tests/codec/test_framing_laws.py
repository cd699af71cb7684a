"""The framing laws, as properties of both codecs."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.editions.mycobot import TABLE
from framed_events import cut, joined

CODECS = st.sampled_from([codecs.load(TABLE, "reference"), codecs.load(TABLE, "native")])
LISTENING = st.sampled_from(["request", "reply", "both"])
LONGEST = TABLE.frame.maximum_length + TABLE.frame.overhead


@given(CODECS, LISTENING, st.data())
def test_every_byte_is_in_exactly_one_event(
    codec: Codec, listening: Listening, data: st.DataObject
) -> None:
    stream = data.draw(strategies.streams())
    framer = codec.framer(listening)
    fed = 0
    events: list[Event] = []
    for chunk in data.draw(strategies.chunked(stream)):
        events += framer.feed(chunk)
        fed += len(chunk)
        assert sum(len(event.data) for event in events) + framer.pending == fed
        assert framer.pending < LONGEST
    events += framer.flush()
    assert framer.pending == 0
    assert b"".join(event.data for event in events) == stream
    assert all(a.offset + len(a.data) == b.offset for a, b in pairwise(events))
    assert not events or events[0].offset == 0


@given(CODECS, LISTENING, st.data())
def test_events_do_not_depend_on_chunking(
    codec: Codec, listening: Listening, data: st.DataObject
) -> None:
    stream = data.draw(strategies.streams())
    chunks = data.draw(strategies.chunked(stream))
    assert joined(cut(codec, listening, chunks)) == joined(cut(codec, listening, [stream]))


@given(CODECS, st.data())
def test_undamaged_frame_is_found_unless_a_legal_one_covers_it(
    codec: Codec, data: st.DataObject
) -> None:
    before, frame, after = (
        data.draw(strategies.line_noise() | strategies.near_frames()),
        data.draw(strategies.real_frames()),
        data.draw(strategies.line_noise()),
    )
    events = cut(codec, "both", [before, frame, after])
    start = len(before)
    if Frame(start, frame, frame[3]) in events:
        return
    # If it is missing, a legal frame that starts earlier covers its start.
    covers = [e for e in events if isinstance(e, Frame) and e.offset < start]
    assert covers
    assert covers[-1].offset + len(covers[-1].data) > start


@given(CODECS, strategies.real_frames(), st.integers(1, 40))
def test_adjacent_frames_are_all_found(codec: Codec, frame: bytes, times: int) -> None:
    events = cut(codec, "both", [frame * times])
    assert events == [Frame(index * len(frame), frame, frame[3]) for index in range(times)]


def test_every_split_of_a_noisy_stream_has_the_same_events(codec: Codec) -> None:
    stream = bytes.fromhex("FF FE FE FE 0E 20 FE FE 03 12 01 FA FE FE 99 FE FE 0E 20") + bytes(13)
    whole = joined(cut(codec, "reply", [stream]))
    for at in range(len(stream) + 1):
        assert joined(cut(codec, "reply", [stream[:at], stream[at:]])) == whole
    assert joined(cut(codec, "reply", [bytes([byte]) for byte in stream])) == whole


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


def test_false_header_is_refuted_by_its_fourth_byte(codec: Codec) -> None:
    framer = codec.framer("reply")
    assert framer.feed(bytes.fromhex("FE FE 0E")) == []
    assert framer.feed(b"\x12") != [], "0x12 has no reply with LEN 0E"


def test_frame_after_a_false_header_is_returned_by_flush(codec: Codec) -> None:
    framer = codec.framer("reply")
    frame = bytes.fromhex("FE FE 03 12 01 FA")
    assert framer.feed(bytes.fromhex("FE FE 0E 20") + frame) == []
    assert Frame(4, frame, 0x12) in framer.flush()


def test_unknown_id_is_accepted_on_request(codec: Codec) -> None:
    frame = bytes.fromhex("FE FE 04 E0 01 02 FA")
    assert all(isinstance(event, Noise) for event in codec.framer("reply").feed(frame))
    assert codec.framer("reply", accept_unknown=True).feed(frame) == [Frame(0, frame, 0xE0)]
