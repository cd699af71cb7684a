"""Segments of a stream, decoded on their own, hold exactly what one scan finds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

import random_tables
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.columns import Columns
from cobotwire.codec.interface import Codec, Listening
from cobotwire.codec.segments import PATIENCE, Divider, decode_segment, even_cuts
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table
from codec.results import joined_columns
from strategies import CODECS, TABLES, codec_of

LISTENING = st.sampled_from(["request", "reply", "both"])
EACH_CODEC = pytest.mark.parametrize("name", CODECS)
FLAG = bytes.fromhex("FE FE 03 12 01 FA")
# Frames of 17 bytes that contain a frame of 6 bytes: a scan that starts inside one finds other
# frames.
OUTER = bytes.fromhex("FE FE 0E 20 FE FE 03 12 01 FA FE FE 03 12 01 FA FA")


class Bytes(NamedTuple):
    """A stream in memory."""

    data: bytes

    @property
    def size(self) -> int:
        return len(self.data)

    def read(self, offset: int, size: int) -> bytes:
        return self.data[offset : offset + size]


def found(parts: Sequence[Columns], ends: Sequence[Columns]) -> Any:
    """Join columns in their order; ``ends`` have the counters of the segments."""
    counts: Counter[Any] = Counter()
    for end in ends:
        counts.update(end.counters.frames)
        counts.update(end.counters.noise)
        counts["bytes"] += end.counters.bytes
    return joined_columns(parts), counts


def whole(codec: Codec, listening: Listening, data: bytes, raw: bool = False) -> Any:
    columns = codec.decode_columns(data, listening, raw=raw)
    return found([columns], [columns])


def divided(
    codec: Codec,
    listening: Listening,
    data: bytes,
    cuts: Sequence[int],
    patience: int = PATIENCE,
    chunk: int = 1 << 20,
    raw: bool = False,
) -> Any:
    """Decode every piece on its own."""
    stream = Bytes(data)
    parts: list[Columns] = []
    ends: list[Columns] = []
    for piece in range(len(cuts) + 1):
        # Each worker has a divider of its own.
        segment = Divider(codec, listening, stream, cuts, patience).segment(piece)
        decoded = list(decode_segment(codec, listening, stream, segment, raw=raw, chunk=chunk))
        parts += decoded
        ends.append(decoded[-1])
    return found(parts, ends)


@st.composite
def cuts(draw: st.DrawFn, size: int) -> list[int]:
    """Draw arbitrary cuts, of which some may be equal, or evenly spaced ones."""
    if draw(st.booleans()):
        return list(even_cuts(size, draw(st.integers(1 + size // 12, size + 1))))
    return sorted(draw(st.lists(st.integers(0, size), max_size=6)))


def adversarial(draw: st.DrawFn) -> bytes:
    """Draw chains of frames within frames; each may be read in two ways."""
    step = draw(st.sampled_from([OUTER, OUTER[:4] + FLAG + OUTER[:4] + FLAG[:3], OUTER[4:], FLAG]))
    start = draw(st.integers(0, len(step)))
    return step[start:] + step * draw(st.integers(0, 40)) + step[: draw(st.integers(0, 17))]


@st.composite
def streams(draw: st.DrawFn, table: Table) -> bytes:
    """Draw the bytes of a bad line, some of them made to mislead a scan."""
    parts = [draw(random_tables.any_streams(table))]
    if table in TABLES.values() and draw(st.booleans()):
        parts += [adversarial(draw), draw(strategies.streams(table))]
    return b"".join(parts)


@given(table=random_tables.any_tables(), data=st.data(), listening=LISTENING, raw=st.booleans())
def test_segments_cut_at_any_bytes_hold_what_one_scan_finds(
    table: Table, data: st.DataObject, listening: Listening, raw: bool
) -> None:
    """This holds for any header, layout, check and id, and for replies without an id."""
    codec = codecs.load(table, data.draw(st.sampled_from(CODECS)))
    stream = data.draw(streams(table))
    pieces = divided(
        codec,
        listening,
        stream,
        data.draw(cuts(len(stream))),
        patience=data.draw(st.sampled_from([0, 5, 40, PATIENCE])),
        chunk=data.draw(st.sampled_from([1, 7, 64, 1 << 20])),
        raw=raw,
    )
    assert pieces == whole(codec, listening, stream, raw)


@EACH_CODEC
def test_chain_of_frames_within_frames_is_read_from_its_start(name: codecs.CodecName) -> None:
    """No scan from inside the chain meets the scan from its start, so one segment has all of it."""
    # A frame at 0, 17, 34 and so on, and one across the end of each: two readings that never meet.
    link = bytes.fromhex("FE FE 0E 20 00 00 00 FA FE FE 0E 20 00 00 00 00 FA")
    stream = b"\0" + link * 400 + b"\0\0" + FLAG
    codec = codec_of("mycobot", name)
    places = list(even_cuts(len(stream), 1000))
    divider = Divider(codec, "reply", Bytes(stream), places, patience=200)
    assert [bool(divider.segment(piece)) for piece in range(7)] == [True] + [False] * 6
    assert divided(codec, "reply", stream, places, patience=200) == whole(codec, "reply", stream)


@EACH_CODEC
def test_scans_of_a_clean_line_meet_within_two_frames(name: codecs.CodecName) -> None:
    codec = codec_of("mycobot280", name)
    stream = Bytes((OUTER[:4] + bytes(12) + b"\xfa") * 100)
    divider = Divider(codec, "reply", stream, [])
    for cut in range(1, 200):
        point = divider.meeting_point(cut)
        assert point is not None
        assert point % 17 == 0
        assert cut <= point < cut + 17 + 29


@EACH_CODEC
def test_offset_of_a_reader_is_where_its_stream_begins(name: codecs.CodecName) -> None:
    codec = codec_of("mycobot280", name)
    reader = codec.column_reader("reply", offset=1 << 40)
    parts = [reader.feed(FLAG + b"\0" + FLAG[:3]), reader.feed(FLAG[3:] + FLAG[:4] + b"\7\xfa")]
    parts.append(reader.flush())
    offsets = [at - (1 << 40) for part in parts for rows in part for at in rows.offset.tolist()]
    assert offsets == [0, 7]
    assert [at - (1 << 40) for part in parts for at in part.rejected.tolist()] == [13]
    assert [at - (1 << 40) for part in parts for at in part.noise.offset.tolist()] == [6]
    assert parts[-1].counters.bytes == 19


@EACH_CODEC
@pytest.mark.parametrize("wrong", [-1, 1 << 63, 1.5, "0"])
def test_offset_that_no_stream_has_is_rejected(name: codecs.CodecName, wrong: Any) -> None:
    with pytest.raises(UsageError, match="allowed: 0 to"):
        codec_of("mycobot280", name).column_reader("reply", offset=wrong)
