"""The dissector shows the Python framer's events for any stream in any packets."""

from __future__ import annotations

import struct
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import damage
from cobotwire.capture.block_encoding import SIMPLE_PACKET, interface, section
from cobotwire.codec.interface import Listening
from codec.test_found import STREAMS
from strategies import TABLES, chunked, codec_of, received, streams
from streams import stream_a
from targets.built import built
from targets.wireshark.captures import STEP_NS, Chunk, pcap, segment, serial, tcp
from targets.wireshark.dissecting import (
    Item,
    dissected,
    events_of,
    joined,
    needs_tshark,
    summary,
    tshark,
)

pytestmark = needs_tshark
EDITIONS = sorted(TABLES)
SILENCE_NS = 600_000_000
FRAME = bytes.fromhex("FE FE 0E 20 00 01 FF FF 00 03 00 04 00 05 00 06 FA")
ON = bytes.fromhex("FE FE 03 12 01 FA")


class Cut(NamedTuple):
    """One direction of a line: its chunks, each with whether silence follows it."""

    direction: Listening
    chunks: list[tuple[bytes, bool]]

    @property
    def data(self) -> bytes:
        return b"".join(data for data, _ in self.chunks)


def packets_of(lines: Sequence[Cut]) -> list[Chunk]:
    """Return the chunks of all lines in turn; each line has its own clock."""
    found = []
    clocks = [0] * len(lines)
    for turn in range(max(len(line.chunks) for line in lines)):
        for number, line in enumerate(lines):
            if turn < len(line.chunks) and line.chunks[turn][0]:
                data, silent = line.chunks[turn]
                found.append(Chunk(number, line.direction, data, clocks[number]))
                clocks[number] += SILENCE_NS if silent else STEP_NS
    return found


def shown_by_line(data: bytes, chunks: list[Chunk], edition: str) -> dict[int, list[list[Item]]]:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "line.pcapng"
        path.write_bytes(data)
        shown = dissected(path, edition, *(["-d", f"tcp.port==9000,{edition}"]))
    lines: dict[int, list[list[Item]]] = defaultdict(list)
    for chunk, items in zip(chunks, shown, strict=True):
        lines[chunk.line].append(items)
    return lines


def agrees(lines: Sequence[Cut], edition: str, over_tcp: bool) -> None:
    """Check that the dissector's events of every line are the framer's, byte for byte."""
    chunks = packets_of(lines)
    write = tcp if over_tcp else serial
    shown = shown_by_line(write(chunks, edition), chunks, edition)
    codec = codec_of(edition, "native")
    for number, line in enumerate(lines):
        truth = events_of(codec, line.direction, line.chunks)
        assert joined(shown[number]) == summary(truth, line.data), line


@st.composite
def cuts(draw: st.DrawFn, edition: str, directions: list[Listening]) -> Cut:
    direction = draw(st.sampled_from(directions))
    table = TABLES[edition]
    data = draw(streams(table) | received(table, direction).map(lambda line: line.data))
    return Cut(direction, [(chunk, False) for chunk in draw(chunked(data))])


@pytest.mark.parametrize("over_tcp", [False, True], ids=["serial", "tcp"])
@settings(max_examples=4, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_any_stream_cut_anywhere_shows_the_framers_events(
    over_tcp: bool, data: st.DataObject
) -> None:
    edition = data.draw(st.sampled_from(EDITIONS))
    ways: list[Listening] = ["request", "reply"] if over_tcp else ["request", "reply", "both"]
    lines = data.draw(st.lists(cuts(edition, ways), min_size=1, max_size=30))
    agrees(lines, edition, over_tcp)


@pytest.mark.parametrize("edition", EDITIONS)
def test_found_streams_show_the_framers_events(edition: str) -> None:
    found = [each for each in STREAMS if each.table == edition and not each.unknown]
    assert len(found) >= 3
    agrees([Cut(each.listening, each.chunks) for each in found], edition, over_tcp=False)


def test_frame_over_several_packets_names_its_first_and_last(tmp_path: Path) -> None:
    path = tmp_path / "line.pcapng"
    pieces = [FRAME[:5], FRAME[5:9], FRAME[9:] + ON[:3]]
    path.write_bytes(serial([Chunk(0, "reply", piece) for piece in pieces], "mycobot"))
    first, second, last = dissected(path, "mycobot", "-2", "-R", "frame")
    assert first[0].own["continued_in"] == "2"
    assert second[0].own["continued_in"] == "3"
    assert [item.kind for item in last] == ["frame", "incomplete"]
    assert last[0].data == FRAME
    assert "continued_in" not in last[1].own
    assert last[1].experts == ["incomplete.expert"]
    assert first[0].experts == []
    began = tshark(path, "-Y", "mycobot.began_in", "-T", "fields", "-e", "mycobot.began_in")
    assert began.split() == ["1", "1"]


def test_frame_in_one_packet_names_no_other(tmp_path: Path) -> None:
    path = tmp_path / "line.pcapng"
    path.write_bytes(serial([Chunk(0, "reply", piece) for piece in (FRAME, ON, ON)], "mycobot"))
    assert tshark(path, "-Y", "mycobot.began_in || mycobot.continued_in") == ""


def test_silence_ends_a_waiting_candidate_on_serial_but_not_on_tcp(tmp_path: Path) -> None:
    path = tmp_path / "line"
    chunks = [Chunk(0, "reply", FRAME[:6], 0), Chunk(0, "reply", ON, SILENCE_NS)]
    path.write_bytes(serial(chunks, "mycobot"))
    assert joined(dissected(path, "mycobot")) == [
        ("truncated", FRAME[:1]),
        ("no-header", FRAME[1:6]),
        ("frame", ON),
    ]
    # As in the recorder, a silence lasts half a second or more.
    for gap, kind in ((499_000_000, "frame"), (500_000_000, "truncated")):
        path.write_bytes(
            serial([Chunk(0, "reply", FRAME[:6], 0), Chunk(0, "reply", FRAME[6:], gap)], "mycobot")
        )
        assert joined(dissected(path, "mycobot"))[0][0] == kind
    # TCP resends a lost segment after about a second, so a frame must wait that long.
    path.write_bytes(tcp([Chunk(0, "reply", FRAME[:6], 0), Chunk(0, "reply", FRAME[6:], 10**9)]))
    assert joined(dissected(path, "mycobot280"))[-1] == ("frame", FRAME)


NO_ANALYSIS = ("-o", "tcp.analyze_sequence_numbers:FALSE")
IN_ORDER = ("-o", "tcp.reassemble_out_of_order:TRUE")


def segments(
    folder: Path, *parts: tuple[int, bytes], words: Sequence[str] = ()
) -> list[list[Item]]:
    """Return what is shown of segments of one direction, each given with its stream offset."""
    packets = [segment(Chunk(0, "reply", data), 1000 + at, False) for at, data in parts]
    path = folder / "segments.pcap"
    path.write_bytes(pcap((number * 1000, data) for number, data in enumerate(packets)))
    return dissected(path, "mycobot280", *words)


def bytes_in(shown: list[list[Item]]) -> list[list[bytes]]:
    return [[item.data for item in items] for items in shown]


def test_retransmitted_segment_is_shown_once(tmp_path: Path) -> None:
    again = (0, FRAME[:9]), (0, FRAME[:9]), (9, FRAME[9:]), (9, FRAME[9:])
    for words in ((), NO_ANALYSIS):
        assert bytes_in(segments(tmp_path, *again, words=words))[2:] == [[FRAME], []]


def test_overlapping_segment_is_shown_only_without_sequence_analysis(tmp_path: Path) -> None:
    parts = (0, FRAME[:9]), (5, FRAME[5:] + ON), (23, ON)
    # Wireshark gives it to a dissector only if it does not analyze sequence numbers.
    assert bytes_in(segments(tmp_path, *parts))[1:] == [[], [FRAME[:1], FRAME[1:9], ON]]
    assert bytes_in(segments(tmp_path, *parts, words=NO_ANALYSIS))[1:] == [[FRAME, ON], [ON]]


def test_segment_out_of_order_fills_the_gap_unless_wireshark_drops_it(tmp_path: Path) -> None:
    parts = (0, ON), (23, ON), (6, FRAME)
    assert bytes_in(segments(tmp_path, *parts, words=IN_ORDER)) == [[ON], [], [FRAME, ON]]
    # The late segment fills its gap, or Wireshark gives it to no dissector.
    assert bytes_in(segments(tmp_path, *parts, words=NO_ANALYSIS)) == [[ON], [ON], [FRAME]]
    assert bytes_in(segments(tmp_path, *parts)) == [[ON], [ON], []]
    path = tmp_path / "segments.pcap"
    missing = tshark(path, "-Y", "mycobot280.missing", "-T", "fields", "-e", "frame.number")
    assert missing.split() == ["2"]


def test_lost_segment_ends_the_waiting_frame(tmp_path: Path) -> None:
    lost = segments(tmp_path, (0, FRAME[:9]), (23, ON))
    assert [(item.kind, item.data) for item in lost[1]] == [
        ("truncated", FRAME[:1]),
        ("no-header", FRAME[1:9]),
        ("frame", ON),
    ]


@pytest.mark.parametrize("over_tcp", [False, True], ids=["serial", "tcp"])
def test_truncated_capture_is_dissected_without_error(over_tcp: bool, tmp_path: Path) -> None:
    stream = (FRAME + b"\xfe\xfe\x0e" + ON) * 3
    chunks = [Chunk(0, "reply", stream[at : at + 7]) for at in range(0, len(stream), 7)]
    whole = (tcp if over_tcp else serial)(chunks, "mycobot280")
    path = tmp_path / "whole"
    path.write_bytes(whole)
    shown = dissected(path, "mycobot280")
    random = np.random.default_rng(int(over_tcp))
    for size in random.integers(len(whole) // 3, len(whole), 3):
        path.write_bytes(whole[: int(size)])
        cut = dissected(path, "mycobot280")
        assert [[i.data for i in items] for items in cut] == [
            [i.data for i in items] for items in shown[: len(cut)]
        ]


def test_packets_truncated_by_the_capture_are_marked(tmp_path: Path) -> None:
    packet = segment(Chunk(0, "reply", ON + FRAME), 1000, False)
    path = tmp_path / "snapped.pcap"
    data = pcap([(0, packet), (1, segment(Chunk(0, "reply", ON), 1023, False))])
    # Shorten the first record's captured length and remove the bytes beyond it.
    short = len(packet) - 8
    head = 24 + 16
    data = (
        data[:32] + struct.pack("<I", short) + data[36 : head + short] + data[head + len(packet) :]
    )
    path.write_bytes(data)
    first, second = dissected(path, "mycobot280")
    assert [(i.kind, i.data) for i in first] == [
        ("frame", ON),
        ("truncated", FRAME[:1]),
        ("no-header", FRAME[1:9]),
    ]
    assert [i.data for i in second] == [ON]
    marked = tshark(path, "-Y", "mycobot280.cut_off", "-T", "fields", "-e", "frame.number")
    assert marked.split() == ["1"]
    # The bytes that the capture cut off were on the line, so no segment is missing.
    assert not tshark(path, "-Y", "mycobot280.missing", "-T", "fields", "-e", "frame.number")


def test_packets_without_time_or_direction_are_dissected(tmp_path: Path) -> None:
    """Read simple packets of pcapng, as other programs write them."""
    path = tmp_path / "simple.pcapng"
    query = bytes.fromhex("FE FE 02 12 FA")
    packets = []
    for data in (query, ON):
        padded = data + bytes(-len(data) % 4)
        size = 16 + len(padded)
        packets.append(struct.pack("<III", SIMPLE_PACKET, size, len(data)) + padded)
        packets[-1] += struct.pack("<I", size)
    path.write_bytes(section("test") + interface("", "", 0) + b"".join(packets))
    requests, replies = dissected(path, "mycobot", scripts=[built("wireshark") / "mycobot.lua"])
    assert (requests[0].own["frame.direction"], requests[0].data) == ("request", query)
    assert (replies[0].own["frame.direction"], replies[0].data) == ("reply", ON)
    assert replies[0].own["request_in"] == "1"


def test_order_of_dissection_does_not_change_the_result(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    stream = damage.damage(TABLES["mycobot"], stream_a(TABLES["mycobot"], 60), "mixed", 0.01).data
    ends = np.cumsum(random.integers(1, 30, len(stream) // 15))
    chunks = [Chunk(0, "reply", stream[a:b]) for a, b in zip([0, *ends], ends) if stream[a:b]]
    path = tmp_path / "line.pcapng"
    path.write_bytes(serial(chunks, "mycobot"))
    once = dissected(path, "mycobot")
    # Dissect in two passes, the second over a part of the packets.
    again = dissected(path, "mycobot", "-2", "-R", "frame", "-Y", "frame.number > 20")
    assert len(again) == len(once) - 20
    for before, now in zip(once[20:], again, strict=True):
        assert [(i.kind, i.data) for i in before] == [(i.kind, i.data) for i in now]
