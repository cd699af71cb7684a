"""Columns: what framer and decoder give, in bulk; the same from both codecs and in any pieces."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import strategies
from cobotwire.codec.interface import Codec, Columns, Frame, Listening, Noise
from cobotwire.errors import ProtocolError, UsageError
from strategies import TABLES, codec_of

CODECS = ["reference", "native"]
LISTENING = st.sampled_from(["request", "reply", "both"])
EACH_EDITION = pytest.mark.parametrize("edition", TABLES)
ANGLES = bytes.fromhex("FE FE 0E 20 00 64 00 C8 01 2C 01 90 01 F4 02 8A FA")
FLAG = bytes.fromhex("FE FE 03 12 01 FA")


def plain(columns: Columns) -> Any:
    """The angles, as lists."""
    return columns.rows("get_angles")["angles"].tolist()


def contents(columns: Columns) -> Any:
    """Everything that columns hold, as plain Python values."""
    rows = [
        (
            rows.command.name,
            rows.direction,
            rows.form,
            rows.offset.tolist(),
            {
                name: (rows[name].format, rows[name].shape, rows[name].tolist())
                for name in rows.names
            },
        )
        for rows in columns
    ]
    noise = columns.noise
    refused = columns.refused.tolist()
    return rows, sorted(refused), noise.offset.tolist(), noise.size.tolist(), columns.counters


def joined(parts: list[Columns]) -> Any:
    """The contents of columns that came one after the other, as of one."""
    rows: dict[Any, Any] = {}
    refused: list[int] = []
    noise: tuple[list[int], list[int]] = ([], [])
    for part in parts:
        for found in part:
            key = found.command.name, found.direction, found.form
            offsets, fields = rows.setdefault(key, ([], {name: [] for name in found.names}))
            offsets += found.offset.tolist()
            for name in found.names:
                fields[name] += found[name].tolist()
        refused += part.refused.tolist()
        noise[0].extend(part.noise.offset.tolist())
        noise[1].extend(part.noise.size.tolist())
    return rows, sorted(refused), noise, parts[-1].counters


@EACH_EDITION
@given(listening=LISTENING, raw=st.booleans(), data=st.data())
def test_both_codecs_give_the_same_columns(
    edition: str, listening: Listening, raw: bool, data: st.DataObject
) -> None:
    stream = data.draw(strategies.streams(TABLES[edition]))
    found = [codec_of(edition, name).decode_columns(stream, listening, raw=raw) for name in CODECS]
    assert contents(found[0]) == contents(found[1])


@EACH_EDITION
@pytest.mark.parametrize("name", CODECS)
@given(listening=LISTENING, raw=st.booleans(), data=st.data())
def test_pieces_give_the_rows_of_the_whole(
    edition: str, name: Any, listening: Listening, raw: bool, data: st.DataObject
) -> None:
    codec = codec_of(edition, name)
    stream = data.draw(strategies.streams(TABLES[edition]))
    reader = codec.column_reader(listening, raw=raw)
    parts = [reader.feed(chunk) for chunk in data.draw(strategies.chunked(stream))]
    parts.append(reader.flush())
    assert reader.pending == 0
    assert joined(parts) == joined([codec.decode_columns(stream, listening, raw=raw)])


@EACH_EDITION
@pytest.mark.parametrize("name", CODECS)
@given(listening=LISTENING, data=st.data())
def test_columns_hold_what_framer_and_messages_say(
    edition: str, name: Any, listening: Listening, data: st.DataObject
) -> None:
    codec = codec_of(edition, name)
    stream = data.draw(strategies.streams(TABLES[edition]))
    framer = codec.framer(listening)
    rows: dict[Any, list[Any]] = {}
    refused = []
    for event in framer.feed(stream) + framer.flush():
        if isinstance(event, Noise):
            continue
        try:
            message = event.message
        except ProtocolError:
            refused.append(event.offset)
        else:
            key = message.command.name, message.direction
            values = [list(v) if isinstance(v, tuple) else v for v in message.values]
            rows.setdefault(key, []).append((event.offset, values))
    columns = codec.decode_columns(stream, listening)
    found: dict[Any, list[Any]] = {}
    for each in columns:
        fields = [each[field].tolist() for field in each.names]
        values = [list(row) for row in zip(*fields)] or [[] for _ in each.offset]
        all_rows = list(zip(each.offset.tolist(), values))
        found.setdefault((each.command.name, each.direction), []).extend(all_rows)
    assert {key: sorted(all_rows) for key, all_rows in found.items()} == rows
    assert sorted(columns.refused.tolist()) == refused
    assert columns.counters == framer.counters


@EACH_EDITION
@given(listening=LISTENING, unknown=st.booleans(), data=st.data())
def test_a_scan_gives_the_frames_and_accounts_for_the_rest(
    edition: str, listening: Listening, unknown: bool, data: st.DataObject
) -> None:
    stream = data.draw(strategies.streams(TABLES[edition]))
    for name in CODECS:
        codec = codec_of(edition, name)
        framer = codec.framer(listening, accept_unknown=unknown)
        events = framer.feed(stream) + framer.flush()
        scan = codec.scan(stream, listening, accept_unknown=unknown)
        assert scan.offset.tolist() == [e.offset for e in events if isinstance(e, Frame)]
        assert scan.counters == framer.counters
        spans = list(zip(scan.noise.offset.tolist(), scan.noise.size.tolist()))
        assert sum(size for _, size in spans) == sum(scan.counters.noise.values())
        assert all(a + size < b for (a, size), (b, _) in pairwise(spans)), "adjacent spans join"


@pytest.mark.parametrize("kind", [bytes, bytearray, memoryview])
def test_any_buffer_will_do(codec: Codec, kind: Any) -> None:
    for times in (1, 30_000):
        columns = codec.decode_columns(kind(ANGLES * times), "reply")
        assert len(columns.rows("get_angles")) == times
        assert plain(columns)[-1] == [1.0, 2.0, 3.0, 4.0, 5.0, 6.5]
    with pytest.raises(TypeError):
        codec.decode_columns(memoryview(ANGLES)[::2])


def test_a_flush_in_the_middle_of_a_stream_shows_in_the_spans_and_nowhere_else(
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


def test_what_is_no_buffer_is_refused(codec: Codec) -> None:
    wrong: Any = "FE FE"
    with pytest.raises(TypeError):
        codec.decode_columns(wrong)
    with pytest.raises(TypeError):
        codec.scan(wrong)


def test_raw_columns_have_the_smallest_type_that_holds_what_is_allowed() -> None:
    for edition, format, least in [("mycobot", "i", -32535), ("mycobot280", "h", -32768)]:
        for name in CODECS:
            stream = ANGLES[:4] + b"\x80\xe9" * 6 + b"\xfa" + FLAG
            columns = codec_of(edition, name).decode_columns(stream, "reply", raw=True)
            angles = columns.rows("get_angles")["angles"]
            assert angles.format == format
            assert min(plain(columns)[0]) >= least
            assert columns.rows("is_power_on")[columns.rows("is_power_on").names[0]].format == "B"


def test_a_frame_with_a_value_that_is_not_allowed_is_told_apart(codec: Codec) -> None:
    bad = bytes.fromhex("FE FE 03 12 07 FA")
    columns = codec.decode_columns(FLAG + bad + FLAG, "reply")
    assert columns.refused.tolist() == [6]
    assert columns.rows("is_power_on").offset.tolist() == [0, 12]
    with pytest.raises(ProtocolError, match="7"):
        codec.decode("reply", bad)


def test_a_message_that_did_not_come_has_no_rows(codec: Codec) -> None:
    columns = codec.decode_columns(FLAG, "reply")
    assert len(columns) == 1
    rows = columns.rows("get_angles")
    assert len(rows) == 0
    assert rows["angles"].tolist() == []
    with pytest.raises(UsageError, match="get_angles"):
        columns.rows("get_angels")
    with pytest.raises(UsageError, match="none"):
        columns.rows("power_on", "reply")
    with pytest.raises(UsageError, match="angles"):
        rows["angels"]


def test_one_of_several_forms_must_be_named_if_several_came() -> None:
    for name in CODECS:
        codec = codec_of("mycobot280", name)
        frames = [codec.encode("power_on", "request", (), form=0)]
        table = codec.table
        several = next(
            command
            for command in table.commands
            if len(command.reply) > 1 and len({form.size for form in command.reply}) > 1
        )
        frames = [
            codec.encode(several.name, "reply", _zeros(form), form=index)
            for index, form in enumerate(several.reply)
        ]
        columns = codec.decode_columns(b"".join(frames), "reply")
        with pytest.raises(UsageError, match="all of them came"):
            columns.rows(several.name)
        assert [len(columns.rows(several.name, form=index)) for index, _ in enumerate(frames)] == [
            1 for _ in frames
        ]


def _zeros(form: Any) -> list[Any]:
    return [
        tuple(0 for _ in field.cases[0].numbers) if field.many else (field.choices or (0,))[0]
        for field in form.fields
    ]


def test_out_gives_its_memory_unless_it_is_looked_at() -> None:
    codec = codec_of("mycobot", "native")
    first = codec.decode_columns(ANGLES * 3, "reply")
    view = first.rows("get_angles")["angles"]
    with pytest.raises(BufferError, match="looked at"):
        codec.decode_columns(ANGLES, "reply", out=first)
    assert len(first.rows("get_angles")) == 3, "who gets the error still has what there was"
    view.release()
    second = codec.decode_columns(ANGLES + FLAG, "reply", out=first)
    assert len(first) == 0
    assert plain(second) == [[1.0, 2.0, 3.0, 4.0, 5.0, 6.5]]
    assert len(second.rows("is_power_on")) == 1
    scan = codec.scan(ANGLES * 3)
    assert codec.scan(ANGLES, out=scan).offset.tolist() == [0]


def test_out_of_other_columns_is_no_danger() -> None:
    codec = codec_of("mycobot", "native")
    raw = codec.decode_columns(ANGLES * 3 + FLAG, "reply", raw=True)
    columns = codec.decode_columns(ANGLES, "reply", out=raw)
    assert columns.rows("get_angles")["angles"].format == "d"
    other = codec_of("mycobot280", "native").decode_columns(ANGLES, "reply", out=columns)
    assert plain(other) == [[1.0, 2.0, 3.0, 4.0, 5.0, 6.5]]


def test_columns_are_read_only(codec: Codec) -> None:
    if codec.name == "native":
        rows = codec.decode_columns(ANGLES, "reply").rows("get_angles")
        assert rows["angles"].readonly
        with pytest.raises(ValueError, match="read-only"):
            rows.to_numpy()["angles"][0] = 1
