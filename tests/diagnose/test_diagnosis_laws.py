"""What holds for the diagnosis of any stream, on both codecs."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

import field
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.diagnose import Diagnoser, Finding, Item, ServoPacket, Span, summary, words
from cobotwire.editions.mycobot import TABLE

CODECS = st.sampled_from([codecs.load(TABLE, "reference"), codecs.load(TABLE, "native")])
LISTENING = st.sampled_from(["request", "reply", "both"])
STREAMS = field.streams() | strategies.streams()


def diagnose(codec: Codec, listening: Listening, chunks: list[bytes]) -> list[Item]:
    framer, diagnoser = codec.framer(listening), Diagnoser(codec, listening)
    items = [item for chunk in chunks for item in diagnoser.feed(framer.feed(chunk))]
    return items + diagnoser.feed(framer.flush()) + diagnoser.flush()


def _pieces(items: list[Item]) -> list[tuple[int, bytes, bool]]:
    """Every span of every item in the order of the stream, and whether it is a frame."""
    return sorted(
        (span.offset, span.data, isinstance(item, Frame))
        for item in items
        for span in (item.spans if isinstance(item, Finding) else [Span(item.offset, item.data)])
    )


@given(CODECS, LISTENING, st.data())
def test_every_byte_of_noise_is_in_one_finding_and_every_frame_comes_through(
    codec: Codec, listening: Listening, data: st.DataObject
) -> None:
    stream = data.draw(STREAMS)
    framer = codec.framer(listening)
    events = [*framer.feed(stream), *framer.flush()]
    items = diagnose(codec, listening, [stream])
    pieces = _pieces(items)
    assert b"".join(piece[1] for piece in pieces) == stream
    assert all(a[0] + len(a[1]) == b[0] for a, b in pairwise(pieces))
    assert [item for item in items if isinstance(item, Frame)] == [
        event for event in events if isinstance(event, Frame)
    ]


@given(CODECS, LISTENING, st.data())
def test_chunking_does_not_matter(codec: Codec, listening: Listening, data: st.DataObject) -> None:
    stream = data.draw(STREAMS)
    whole = diagnose(codec, listening, [stream])
    assert diagnose(codec, listening, data.draw(strategies.chunked(stream))) == whole
    assert diagnose(codec, listening, [bytes([byte]) for byte in stream]) == whole


@given(LISTENING, st.data())
def test_both_codecs_lead_to_the_same_findings(listening: Listening, data: st.DataObject) -> None:
    stream = data.draw(STREAMS)
    one, other = (codecs.load(TABLE, name) for name in ("reference", "native"))
    assert diagnose(one, listening, [stream]) == diagnose(other, listening, [stream])


@given(CODECS, st.data())
def test_items_come_in_the_order_of_the_stream_and_have_words(
    codec: Codec, data: st.DataObject
) -> None:
    items = diagnose(codec, "both", [data.draw(STREAMS)])
    assert all(a.offset < b.offset for a, b in pairwise(items))
    findings = [item for item in items if isinstance(item, Finding)]
    assert all(words(finding) and "\n" not in words(finding) for finding in findings)
    assert bool(summary(findings)) == bool(findings)


@given(CODECS, field.servo_packets(), strategies.real_frames(), st.data())
def test_a_servo_packet_is_found_even_with_a_frame_in_its_middle(
    codec: Codec, packet: bytes, frame: bytes, data: st.DataObject
) -> None:
    cut = data.draw(st.integers(0, len(packet)))
    before, behind = packet[:cut], packet[cut:]
    items = diagnose(codec, "both", [before + frame + behind])
    # By chance, the packet's bytes may be a frame themselves, or make one with the frame's.
    if not any(isinstance(i, Frame) and (i.offset, i.data) == (cut, frame) for i in items):
        return
    if sum(isinstance(item, Frame) for item in items) > 1:
        return
    found = [item for item in items if isinstance(item, ServoPacket)]
    assert [item.data for item in found] == [packet]


@given(CODECS, field.servo_packets(), st.data())
def test_a_servo_packet_with_a_wrong_byte_is_none(
    codec: Codec, packet: bytes, data: st.DataObject
) -> None:
    at = data.draw(st.integers(2, len(packet) - 1))
    flip = data.draw(st.integers(1, 255))
    spoilt = packet[:at] + bytes([packet[at] ^ flip]) + packet[at + 1 :]
    found = [i for i in diagnose(codec, "both", [spoilt]) if isinstance(i, ServoPacket)]
    assert all(item.data != spoilt for item in found)


@given(CODECS, LISTENING, st.lists(field.noise() | strategies.real_frames(), max_size=30))
def test_memory_stays_bounded(codec: Codec, listening: Listening, pieces: list[bytes]) -> None:
    framer, diagnoser = codec.framer(listening), Diagnoser(codec, listening)
    fed: list[Event] = []
    given_back = 0
    for piece in pieces * 3:
        events = framer.feed(piece)
        fed += events
        given_back += sum(len(item.data) for item in diagnoser.feed(events))
        noise = sum(len(event.data) for event in fed if isinstance(event, Noise))
        frames = sum(len(event.data) for event in fed if isinstance(event, Frame))
        assert noise + frames - given_back < 9000
