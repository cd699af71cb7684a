"""Check the laws of diagnosis on random streams, with both codecs and other frame formats."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

import diagnosed_formats
import field
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Event, Frame, Listening, Noise
from cobotwire.diagnose import Diagnoser, Finding, Item, ServoPacket, Span, summarize
from cobotwire.editions.mycobot import TABLE
from diagnosing import diagnose

CODECS = st.sampled_from([codecs.load(TABLE, "reference"), codecs.load(TABLE, "native")])
LISTENING = st.sampled_from(["request", "reply", "both"])
STREAMS = field.streams() | strategies.streams()
# A codec and a stream of its format.
LINES = st.tuples(CODECS, STREAMS) | st.sampled_from(diagnosed_formats.CODECS).flatmap(
    lambda codec: st.tuples(st.just(codec), diagnosed_formats.streams(codec))
)
Line = tuple[Codec, bytes]


def _pieces(items: list[Item]) -> list[tuple[int, bytes, bool]]:
    """Return every span of every item in order, and whether it belongs to a frame."""
    return sorted(
        (span.offset, span.data, isinstance(item, Frame))
        for item in items
        for span in (item.spans if isinstance(item, Finding) else [Span(item.offset, item.data)])
    )


@given(LINES, LISTENING)
def test_every_byte_of_noise_is_in_one_finding_and_every_frame_passes_through(
    line: Line, listening: Listening
) -> None:
    codec, stream = line
    framer = codec.framer(listening)
    events = [*framer.feed(stream), *framer.flush()]
    items = diagnose(codec, stream, listening=listening)
    pieces = _pieces(items)
    assert b"".join(piece[1] for piece in pieces) == stream
    assert all(a[0] + len(a[1]) == b[0] for a, b in pairwise(pieces))
    assert [item for item in items if isinstance(item, Frame)] == [
        event for event in events if isinstance(event, Frame)
    ]


@given(LINES, LISTENING, st.data())
def test_findings_do_not_depend_on_chunking(
    line: Line, listening: Listening, data: st.DataObject
) -> None:
    codec, stream = line
    whole = diagnose(codec, stream, listening=listening)
    assert diagnose(codec, *data.draw(strategies.chunked(stream)), listening=listening) == whole
    assert diagnose(codec, *[bytes([byte]) for byte in stream], listening=listening) == whole


@given(CODECS, st.data())
def test_items_are_in_the_order_of_the_stream_and_have_descriptions(
    codec: Codec, data: st.DataObject
) -> None:
    items = diagnose(codec, data.draw(STREAMS), listening="both")
    assert all(a.offset < b.offset for a, b in pairwise(items))
    findings = [item for item in items if isinstance(item, Finding)]
    assert all(finding.describe() and "\n" not in finding.describe() for finding in findings)
    assert bool(summarize(findings)) == bool(findings)


@given(CODECS, field.servo_packets(), strategies.real_frames(), st.data())
def test_servo_packet_is_recognised_when_a_frame_interrupts_it(
    codec: Codec, packet: bytes, frame: bytes, data: st.DataObject
) -> None:
    cut = data.draw(st.integers(0, len(packet)))
    before, after = packet[:cut], packet[cut:]
    items = diagnose(codec, before + frame + after, listening="both")
    # By chance the bytes of the packet may be a frame, or form one with bytes of the frame.
    if not any(isinstance(i, Frame) and (i.offset, i.data) == (cut, frame) for i in items):
        return
    if sum(isinstance(item, Frame) for item in items) > 1:
        return
    found = [item for item in items if isinstance(item, ServoPacket)]
    assert [item.data for item in found] == [packet]


@given(CODECS, field.servo_packets(), st.data())
def test_servo_packet_with_a_wrong_byte_is_not_recognised(
    codec: Codec, packet: bytes, data: st.DataObject
) -> None:
    at = data.draw(st.integers(2, len(packet) - 1))
    flip = data.draw(st.integers(1, 255))
    damaged = packet[:at] + bytes([packet[at] ^ flip]) + packet[at + 1 :]
    found = [i for i in diagnose(codec, damaged, listening="both") if isinstance(i, ServoPacket)]
    assert all(item.data != damaged for item in found)


@given(CODECS, LISTENING, st.lists(field.noise() | strategies.real_frames(), max_size=30))
def test_diagnoser_holds_back_a_bounded_number_of_bytes(
    codec: Codec, listening: Listening, pieces: list[bytes]
) -> None:
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
