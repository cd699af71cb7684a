"""Columns equal the results of framer and decoder, for both codecs and any chunking."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import random_tables
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Columns, Listening
from cobotwire.protocol.errors import ProtocolError, UsageError
from cobotwire.protocol.table import Table
from codec.results import check_against_framer, joined_columns
from strategies import CODECS, TABLES, codec_of

LISTENING = st.sampled_from(["request", "reply", "both"])
EACH_EDITION = pytest.mark.parametrize("edition", TABLES)
ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
COORDS = bytes.fromhex("FE FE 0E 23 01 BC FD A0 10 0D DC 66 FF 54 DE 21 FA")
FLAG = bytes.fromhex("FE FE 03 12 01 FA")


def plain(columns: Columns) -> Any:
    """Return the angles, as lists."""
    return columns.rows("get_angles")["angles"].tolist()


@given(random_tables.any_tables(), LISTENING, st.booleans(), st.data())
def test_stream_in_chunks_has_the_same_rows(
    table: Table, listening: Listening, raw: bool, data: st.DataObject
) -> None:
    codec = codecs.load(table, data.draw(st.sampled_from(CODECS)))
    stream = data.draw(random_tables.any_streams(table))
    reader = codec.column_reader(listening, raw=raw)
    parts = [reader.feed(chunk) for chunk in data.draw(strategies.chunked(stream))]
    parts.append(reader.flush())
    assert reader.pending == 0
    whole = codec.decode_columns(stream, listening, raw=raw)
    assert joined_columns(parts) == joined_columns([whole])
    assert parts[-1].counters == whole.counters


@EACH_EDITION
@pytest.mark.parametrize("name", CODECS)
@given(listening=LISTENING, data=st.data())
def test_columns_and_scan_equal_the_decoded_frames_and_the_noise_of_a_framer(
    edition: str, name: Any, listening: Listening, data: st.DataObject
) -> None:
    stream = data.draw(strategies.streams(TABLES[edition]))
    check_against_framer(codec_of(edition, name), listening, stream)


@pytest.mark.parametrize("kind", [bytes, bytearray, memoryview])
def test_columns_are_read_from_any_buffer(codec: Codec, kind: Any) -> None:
    for times in (1, 30_000):
        columns = codec.decode_columns(kind(ANGLES * times), "reply")
        assert len(columns.rows("get_angles")) == times
        assert plain(columns)[-1] == [1.0, 2.0, 3.0, 4.0, 5.0, 6.5]
    with pytest.raises(TypeError):
        codec.decode_columns(memoryview(ANGLES)[::2])


def test_flush_inside_a_stream_splits_only_spans_of_noise(
    codec: Codec,
) -> None:
    for pieces, spans in [((b"\0", FLAG), [(0, 1)]), ((b"\0", b"\0" + FLAG), [(0, 1), (1, 1)])]:
        framer, reader = codec.framer("reply"), codec.column_reader("reply")
        parts = []
        for piece in pieces:
            parts += [reader.feed(piece), reader.flush()]
            framer.feed(piece)
            framer.flush()
        found = [
            span
            for part in parts
            for span in zip(part.noise.offset.tolist(), part.noise.size.tolist())
        ]
        assert found == spans
        assert parts[-1].counters == framer.counters
        assert framer.counters.resyncs == 1


def test_object_without_buffer_is_rejected(codec: Codec) -> None:
    wrong: Any = "FE FE"
    with pytest.raises(TypeError):
        codec.decode_columns(wrong)
    with pytest.raises(TypeError):
        codec.scan(wrong)


def test_raw_column_has_the_smallest_type_for_the_allowed_values() -> None:
    for edition, format, least in [("mycobot", "i", -32535), ("mycobot280", "h", -32768)]:
        for name in CODECS:
            stream = COORDS[:4] + b"\x80\xe9" * 6 + b"\xfa" + FLAG + ANGLES
            columns = codec_of(edition, name).decode_columns(stream, "reply", raw=True)
            coords = columns.rows("get_coords")["coords"]
            assert coords.format == format
            first: Any = coords.tolist()[0]
            assert min(first) >= least
            assert columns.rows("get_angles")["angles"].format == "h"
            assert columns.rows("is_power_on")[columns.rows("is_power_on").names[0]].format == "B"


def test_frame_with_illegal_value_is_listed_as_rejected(codec: Codec) -> None:
    bad = bytes.fromhex("FE FE 03 12 07 FA")
    columns = codec.decode_columns(FLAG + bad + FLAG, "reply")
    assert columns.rejected.tolist() == [6]
    assert columns.rows("is_power_on").offset.tolist() == [0, 12]
    with pytest.raises(ProtocolError, match="7"):
        codec.decode("reply", bad)


def test_message_that_did_not_occur_has_no_rows(codec: Codec) -> None:
    columns = codec.decode_columns(FLAG, "reply")
    assert len(columns) == 1
    rows = columns.rows("get_angles")
    assert len(rows) == 0
    assert rows["angles"].tolist() == []
    with pytest.raises(UsageError, match="get_angles"):
        columns.rows("get_angels")
    with pytest.raises(UsageError, match="power_on has no reply in a frame"):
        columns.rows("power_on", "reply")
    with pytest.raises(UsageError, match="angles"):
        rows["angels"]


def test_variant_must_be_chosen_if_several_occurred() -> None:
    for name in CODECS:
        codec = codec_of("mycobot280", name)
        several = next(
            command
            for command in codec.table.commands
            if len(command.reply) > 1 and len({variant.size for variant in command.reply}) > 1
        )
        frames = [
            codec.encode(several.name, "reply", _zeros(variant), variant=index)
            for index, variant in enumerate(several.reply)
        ]
        columns = codec.decode_columns(b"".join(frames), "reply")
        with pytest.raises(UsageError, match="occurred: choose one with variant="):
            columns.rows(several.name)
        assert [
            len(columns.rows(several.name, variant=index)) for index, _ in enumerate(frames)
        ] == [1 for _ in frames]


def _zeros(variant: Any) -> list[Any]:
    return [
        tuple(0 for _ in field.cases[0].numbers) if field.many else (field.choices or (0,))[0]
        for field in variant.fields
    ]


def test_out_is_reused_unless_a_view_exists() -> None:
    codec = codec_of("mycobot", "native")
    first = codec.decode_columns(ANGLES * 3, "reply")
    view = first.rows("get_angles")["angles"]
    with pytest.raises(BufferError, match="still used"):
        codec.decode_columns(ANGLES, "reply", out=first)
    assert len(first.rows("get_angles")) == 3, "the error leaves the columns intact"
    view.release()
    second = codec.decode_columns(ANGLES + FLAG, "reply", out=first)
    assert len(first) == 0
    assert plain(second) == [[1.0, 2.0, 3.0, 4.0, 5.0, 6.5]]
    assert len(second.rows("is_power_on")) == 1
    scan = codec.scan(ANGLES * 3)
    assert codec.scan(ANGLES, out=scan).offset.tolist() == [0]


def test_out_of_another_kind_or_edition_gives_correct_columns() -> None:
    codec = codec_of("mycobot", "native")
    raw = codec.decode_columns(ANGLES * 3 + FLAG, "reply", raw=True)
    columns = codec.decode_columns(ANGLES, "reply", out=raw)
    assert columns.rows("get_angles")["angles"].format == "d"
    other = codec_of("mycobot280", "native").decode_columns(ANGLES, "reply", out=columns)
    assert plain(other) == [[1.0, 2.0, 3.0, 4.0, 5.0, 6.5]]


def test_columns_of_the_native_codec_are_read_only() -> None:
    rows = codec_of("mycobot", "native").decode_columns(ANGLES, "reply").rows("get_angles")
    assert rows["angles"].readonly
    with pytest.raises(ValueError, match="read-only"):
        rows.to_numpy()["angles"][0] = 1
