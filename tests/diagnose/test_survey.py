"""A survey returns what the diagnoser, the framer and Python's JSON return frame by frame."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import given, settings
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
from cobotwire.diagnose.survey import Lines, StreamSurvey
from cobotwire.protocol.table import Number, Table, Variant

LISTENING = st.sampled_from(["request", "reply", "both"])
# The two formats of the maker, and one with an address and a sum.
NATIVE = {
    name: codecs.load(editions.load(name).TABLE, "native")
    for name in ("mycobot280", "mercury_b1", "mybuddy")
}
FORMATS = [codec for codec in diagnosed_formats.CODECS if StreamSurvey.reads(codec)]
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


def surveyed(
    codec: Codec,
    listening: Listening,
    accept_unknown: bool,
    chunks: Sequence[bytes],
    file: str | None = None,
    *,
    lines: bool = True,
) -> Result:
    """Decode with the native survey."""
    texts = line_texts(codec.table, file) if lines else None
    survey = StreamSurvey(codec, listening, accept_unknown=accept_unknown, texts=texts)
    reader, counts, found = _reader(codec, listening), StreamCounts(), []
    for items in [*map(survey.feed, chunks), survey.flush()]:
        counts.add_findings(items)
        for item in items:
            if isinstance(item, Lines):
                found.append(item.text)
            elif lines or not isinstance(item, Frame):
                found.append(json.dumps(as_object(reader, item)) + "\n")
    counts.add_survey(survey)
    return _result(counts, "".join(found).splitlines(keepends=True))


def check(
    codec: Codec, listening: Listening, stream: bytes, frame: bytes, data: st.DataObject
) -> None:
    """Compare both for a stream that comes twice.

    Python sees the first noise of each class. The second time all classes are known, if frames
    of more bytes than noise can reach over come in between.
    """
    accept = data.draw(st.booleans())
    twice = stream + frame * (1 + 130 // len(frame)) + stream
    cut = data.draw(strategies.chunked(twice))
    expected = diagnosed(codec, listening, accept, twice)
    assert surveyed(codec, listening, accept, cut) == expected
    # Counts alone take another path: frames never leave the native code.
    assert surveyed(codec, listening, accept, cut, lines=False)[1:] == expected[1:]


@pytest.mark.parametrize("edition", NATIVE)
@given(listening=LISTENING, data=st.data())
@settings(max_examples=25)
def test_survey_equals_diagnosis_frame_by_frame(
    edition: str, listening: Listening, data: st.DataObject
) -> None:
    table = editions.load(edition).TABLE
    stream = data.draw(field.streams(table) | strategies.streams(table))
    check(NATIVE[edition], listening, stream, data.draw(strategies.real_frames(table)), data)


@given(st.sampled_from(FORMATS), LISTENING, st.data())
@settings(max_examples=35)
def test_survey_equals_diagnosis_for_any_frame_format(
    codec: Codec, listening: Listening, data: st.DataObject
) -> None:
    frame = codec.encode("get_angles", "request", [])
    check(codec, listening, data.draw(diagnosed_formats.streams(codec)), frame, data)


@given(random_tables.tables(), LISTENING, st.data())
@settings(max_examples=35)
def test_survey_equals_diagnosis_for_any_table(
    table: Table, listening: Listening, data: st.DataObject
) -> None:
    codec = codecs.load(table, "native")
    if StreamSurvey.reads(codec):
        frame = data.draw(random_tables.frames(table))
        check(codec, listening, data.draw(random_tables.streams(table)), frame, data)


@given(LISTENING, st.data())
@settings(max_examples=25)
def test_survey_finds_the_same_ends_of_damaged_frames(
    listening: Listening, data: st.DataObject
) -> None:
    codec = NATIVE["mycobot280"]
    damaged = st.lists(strategies.received(codec.table, listening), max_size=6)
    stream = b"".join(received.data for received in data.draw(damaged))
    check(codec, listening, stream, data.draw(strategies.real_frames(codec.table)), data)


@given(st.lists(st.floats(width=64), min_size=1, max_size=200))
@settings(max_examples=20)
def test_lines_hold_floats_as_python_writes_them(values: list[float]) -> None:
    number = Number("", 8, "big", 0, 1, 1, -(2**63), 2**63 - 1, "", "float")
    reply = small_tables.command(0x20, "get", reply=(Variant((small_tables.field("x", number),)),))
    codec = codecs.load(small_tables.table(reply), "native")
    # Most values of arms are whole numbers of hundredths.
    values += [round(value, 2) for value in values if abs(value) < 1e15]
    data = b"".join(codec.encode("get", "reply", [value]) for value in values)
    lines = surveyed(codec, "reply", False, [data])[0]
    assert lines == diagnosed(codec, "reply", False, data)[0]
