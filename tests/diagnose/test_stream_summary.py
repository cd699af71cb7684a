"""A summary returns what the diagnoser, the framer and Python's JSON return frame by frame."""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import combinations
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import diagnosed_formats
import field
import random_tables
import small_tables
import strategies
from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.cli.shared.item_formats import as_object, line_texts
from cobotwire.codec.interface import Codec, Frame, Listening
from cobotwire.diagnose import Diagnoser
from cobotwire.diagnose.counts import StreamCounts
from cobotwire.diagnose.explain import DIRECTIONS, FrameReader
from cobotwire.diagnose.stream_summary import Lines, StreamSummary
from cobotwire.protocol.table import Number, Table, Variant
from cobotwire.simulator.faults.noise import BOOT, PANIC, servo_packet

LISTENING = st.sampled_from(["request", "reply", "both"])
# The two formats of the maker, and one with an address and a sum.
NATIVE = {
    name: codecs.load(editions.load(name).TABLE, "native")
    for name in ("mycobot280", "mercury_b1", "mybuddy")
}
FORMATS = [codec for codec in diagnosed_formats.CODECS if StreamSummary.reads(codec)]
READABLE = "\t\n\r\x1b" + "".join(map(chr, range(0x20, 0x7F)))
Result = tuple[list[str], dict[str, Any], list[list[Any]], bool]


def _reader(codec: Codec, listening: Listening) -> FrameReader:
    return FrameReader(codec, tuple(d for d in DIRECTIONS if listening in (d, "both")))


def _result(counts: StreamCounts, lines: list[str]) -> Result:
    found = counts.as_dict()
    # The order is part of the result: it decides between equal counts.
    order = [list(found[name].items()) for name in ("frames", "findings")]
    return lines, found, order, counts.only_legal


def diagnosed(codec: Codec, listening: Listening, accept_unknown: bool, data: bytes) -> Result:
    """Decode frame by frame."""
    framer = codec.framer(listening, accept_unknown=accept_unknown)
    diagnoser, reader, counts = (
        Diagnoser(codec, listening),
        _reader(codec, listening),
        StreamCounts(),
    )
    counts.framers.append(framer)
    items = diagnoser.feed([*framer.feed(data), *framer.flush()]) + diagnoser.flush()
    counts.add(items, reader)
    return _result(counts, [json.dumps(as_object(reader, item)) + "\n" for item in items])


def summarized(
    codec: Codec,
    listening: Listening,
    accept_unknown: bool,
    chunks: Sequence[bytes],
    file: str | None = None,
    *,
    lines: bool = True,
) -> Result:
    """Decode with the native summary."""
    texts = line_texts(codec.table, file) if lines else None
    summary = StreamSummary(codec, listening, accept_unknown=accept_unknown, texts=texts)
    reader, counts, found = _reader(codec, listening), StreamCounts(), []
    for items in [*map(summary.feed, chunks), summary.flush()]:
        counts.add_findings(items)
        for item in items:
            if isinstance(item, Lines):
                found.append(item.text)
            elif lines or not isinstance(item, Frame):
                found.append(json.dumps(as_object(reader, item)) + "\n")
    counts.add_summary(summary)
    return _result(counts, "".join(found).splitlines(keepends=True))


def check(
    codec: Codec, listening: Listening, stream: bytes, frame: bytes, data: st.DataObject
) -> None:
    """Compare both for a stream that comes twice.

    Python sees the first noise of each class. The second time all classes are known, because the
    frames in between are too long to be inside one noise.
    """
    accept = data.draw(st.booleans())
    twice = stream + frame * (1 + 130 // len(frame)) + stream
    cut = data.draw(strategies.chunked(twice))
    expected = diagnosed(codec, listening, accept, twice)
    assert summarized(codec, listening, accept, cut) == expected
    # Without lines of output another path is used: frames never leave the native code.
    assert summarized(codec, listening, accept, cut, lines=False)[1:] == expected[1:]


def _received(table: Table, listening: Listening) -> st.SearchStrategy[bytes]:
    """Draw streams in which frames are damaged."""
    pieces = strategies.received(table, listening).map(lambda received: received.data)
    return st.lists(pieces, max_size=6).map(b"".join)


@pytest.mark.parametrize("edition", NATIVE)
@given(listening=LISTENING, data=st.data())
@settings(max_examples=40)
def test_summary_equals_diagnosis_frame_by_frame(
    edition: str, listening: Listening, data: st.DataObject
) -> None:
    table = editions.load(edition).TABLE
    stream = data.draw(
        field.streams(table) | strategies.streams(table) | _received(table, listening)
    )
    check(NATIVE[edition], listening, stream, data.draw(strategies.real_frames(table)), data)


@given(st.sampled_from(FORMATS), LISTENING, st.data())
@settings(max_examples=35)
def test_summary_equals_diagnosis_for_any_frame_format(
    codec: Codec, listening: Listening, data: st.DataObject
) -> None:
    frame = codec.encode("get_angles", "request", [])
    check(codec, listening, data.draw(diagnosed_formats.streams(codec)), frame, data)


@given(random_tables.tables(), LISTENING, st.data())
@settings(max_examples=35)
def test_summary_equals_diagnosis_for_any_table(
    table: Table, listening: Listening, data: st.DataObject
) -> None:
    codec = codecs.load(table, "native")
    if StreamSummary.reads(codec):
        frame = data.draw(random_tables.frames(table))
        check(codec, listening, data.draw(random_tables.streams(table)), frame, data)


FOOTERS = [found for size in range(1, 4) for found in combinations(range(-2, 3), size)]


@pytest.mark.parametrize("footers", FOOTERS, ids=str)
def test_summary_ends_damaged_frame_at_same_of_several_footers(footers: tuple[int, ...]) -> None:
    # LEN is one less than in a reply; the footers are near the end of an undamaged reply.
    frame = bytearray(b"\xfe\xfe\x0d\x20" + bytes(range(0x81, 0x90)))
    for place in footers:
        frame[16 + place] = 0xFA
    codec = NATIVE["mycobot280"]
    apart = codec.encode("get_angles", "request", []) * 20
    data = (bytes(frame) + apart) * 2
    assert summarized(codec, "both", False, [data]) == diagnosed(codec, "both", False, data)


def _read_of(servo: int, register: int, count: int) -> bytes:
    return servo_packet(bytes([servo, 4, 2, register, count]))


def _status_of(servo: int, size: int) -> bytes:
    return servo_packet(bytes([servo, size + 2, 0]) + bytes(size))


@given(st.data())
@settings(max_examples=40)
def test_summary_names_same_registers_if_python_diagnoses_noise_in_between(
    data: st.DataObject,
) -> None:
    codec = NATIVE["mycobot280"]
    servo, size = st.integers(1, 2), st.integers(1, 2)
    packets = st.builds(_read_of, servo, st.sampled_from([0x38, 0x3C]), size)
    packets |= st.builds(_status_of, servo, size)
    packets |= st.just(servo_packet(bytes.fromhex("FE 06 82 38 02 01 02")))
    # Python diagnoses panics and boots, and the noise near them.
    noise = st.sampled_from([b"", PANIC, BOOT, bytes(64)])
    apart = st.sampled_from([0, 20]).map(lambda count: count * codec.encode("stop", "request", []))
    pieces = data.draw(st.lists(st.tuples(packets, noise, packets, apart), min_size=2, max_size=6))
    stream = b"".join(map(b"".join, pieces))
    cut = data.draw(strategies.chunked(stream))
    assert summarized(codec, "both", False, cut) == diagnosed(codec, "both", False, stream)


@given(st.lists(st.text(READABLE, max_size=70), min_size=1, max_size=8))
@example(["x" * size for size in range(1010, 1025)])  # a line is cut after 1024 bytes
@settings(max_examples=30)
def test_lines_hold_texts_as_python_writes_them(texts: list[str]) -> None:
    codec = NATIVE["mycobot280"]
    apart = codec.encode("stop", "request", []) * 20
    data = b"".join(b"text: " + text.encode() + b"\r\n" + apart for text in ["", *texts])
    assert summarized(codec, "both", False, [data]) == diagnosed(codec, "both", False, data)


def test_summary_reads_servo_packets_in_noise_longer_than_it_waits_for() -> None:
    codec = NATIVE["mycobot280"]
    apart = codec.encode("stop", "request", []) * 20
    packets = _read_of(1, 0x38, 2) + _status_of(1, 2) + _read_of(2, 0x3C, 2)
    # The long noise begins between a read and its status, and ends with a read.
    data = packets + apart + packets + apart + _status_of(2, 2) + bytes(2**20 + 9)
    data += _read_of(1, 0x38, 2) + apart + _status_of(1, 2)
    chunks = [data[start : start + 65536] for start in range(0, len(data), 65536)]
    assert summarized(codec, "both", False, chunks) == diagnosed(codec, "both", False, data)


@given(st.lists(st.floats(width=64), min_size=1, max_size=200))
@settings(max_examples=20)
def test_lines_hold_floats_as_python_writes_them(values: list[float]) -> None:
    number = Number("", 8, "big", 0, 1, 1, -(2**63), 2**63 - 1, "", "float")
    reply = small_tables.command(0x20, "get", reply=(Variant((small_tables.field("x", number),)),))
    codec = codecs.load(small_tables.table(reply), "native")
    # Most values of arms are whole numbers of hundredths.
    values += [round(value, 2) for value in values if abs(value) < 1e15]
    data = b"".join(codec.encode("get", "reply", [value]) for value in values)
    lines = summarized(codec, "reply", False, [data])[0]
    assert lines == diagnosed(codec, "reply", False, data)[0]
