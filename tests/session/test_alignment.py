"""After a partly written request, only whole requests of ours form legal frames."""

from __future__ import annotations

from hypothesis import assume, given, settings
from hypothesis import strategies as st

import json_tables
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions import mycobot, mycobot280
from cobotwire.session.alignment import Alignment, Part
from request_parsers import PARSERS, Parser, by_the_law

TABLES = {
    "mycobot": mycobot.TABLE,
    "mycobot280": mycobot280.TABLE,
    "CRC": json_tables.sample("crc"),
    "sum and address": json_tables.sample("sum"),
}
# An example draws one of several tables and one of the codecs.
MORE = settings(max_examples=2 * (settings.default or settings()).max_examples)


def holds_a_frame(parser: Parser, codec: Codec, part: bytes) -> bool:
    """Return whether the part of a frame contains a whole frame."""
    return any(parser(codec, part[start:]) for start in range(1, len(part)))


def _codec(table: str, data: st.DataObject) -> Codec:
    return codecs.load(TABLES[table], data.draw(st.sampled_from(["native", "reference"])))


def _request(codec: Codec, data: st.DataObject) -> bytes:
    variants = [v for v in strategies.variants_of(codec.table) if v.direction == "request"]
    variant = data.draw(st.sampled_from(variants))
    values = data.draw(strategies.legal_values(variant.variant))
    return strategies.frame_of(codec, variant, values)


def _cut(alignment: Alignment, request: bytes, written: int) -> None:
    alignment.cut(alignment.align, request, written)


@MORE
@given(st.sampled_from(sorted(TABLES)), st.data())
def test_next_request_is_the_only_frame_after_a_cut_at_any_position(
    table: str, data: st.DataObject
) -> None:
    codec = _codec(table, data)
    cut, following = _request(codec, data), _request(codec, data)
    for written in range(1, len(cut)):
        alignment = Alignment(codec)
        _cut(alignment, cut, written)
        received = cut[:written] + alignment.align + following
        [part] = alignment.held
        if alignment.align == part.rest:
            # The cut request is completed: with fill bytes, a frame inside it would become legal.
            assert holds_a_frame(by_the_law, codec, cut[:written])
            assert by_the_law(codec, received) == [
                cut,
                following,
            ]
            continue
        for parser in PARSERS:
            assume(not holds_a_frame(parser, codec, cut[:written]))
            assert parser(codec, received) == [following], parser.__name__


@MORE
@given(st.sampled_from(sorted(TABLES)), st.data())
def test_unknown_cut_is_ended_whatever_was_written(table: str, data: st.DataObject) -> None:
    codec = _codec(table, data)
    cut, following = _request(codec, data), _request(codec, data)
    alignment = Alignment(codec)
    alignment.cut(b"", cut, None)
    written = alignment.align + following
    for parser in PARSERS:
        assume(not holds_a_frame(parser, codec, cut))
        for size in range(len(cut) + 1):
            whole = [cut] if size == len(cut) else []
            assert parser(codec, cut[:size] + written) == [*whole, following], size


@MORE
@given(st.sampled_from(sorted(TABLES)), st.data())
def test_cut_within_the_aligning_bytes_is_ended_too(table: str, data: st.DataObject) -> None:
    codec = _codec(table, data)
    cut, second, third = (_request(codec, data) for _ in range(3))
    size = data.draw(st.integers(1, len(cut) - 1))
    assume(not holds_a_frame(by_the_law, codec, cut[:size]))
    alignment = Alignment(codec)
    _cut(alignment, cut, size)
    align = alignment.align
    again = data.draw(st.integers(0, len(align + second) - 1))
    request_part = alignment.cut(align, second, again)
    assert request_part == max(0, again - len(align))
    received = cut[:size] + (align + second)[:again] + alignment.align + third
    frames = by_the_law(codec, received)
    assert frames[-1] == third
    assert frames in ([third], [second, third])


def test_cut_request_that_contains_a_legal_frame_is_completed() -> None:
    codec = codecs.load(mycobot280.TABLE)
    # -2.58 degrees are FE FE, 5.31 are 02 13, and FA is the first byte of -14.64.
    angles = [(-2.58, 5.31, -14.64, 0, 0, 0), 50]
    cut = codec.encode("send_angles", "request", angles)
    stop = codec.encode("stop", "request", [])
    assert bytes.fromhex("FE FE 02 13 FA") in cut, "release_all_servos"
    alignment = Alignment(codec)
    _cut(alignment, cut, 12)
    assert alignment.held == (Part(cut, 12),)
    assert alignment.align == cut[12:]
    alignment.cut(alignment.align, stop, 2)
    assert alignment.align == cut[14:]
    alignment.cut(alignment.align, stop, 4)
    assert alignment.align == b"", "the frame is complete by now"
    assert not alignment.held


def test_cut_of_the_text_after_a_frame_is_not_the_beginning_of_a_frame() -> None:
    codec = codecs.load(mycobot280.TABLE)
    request = codec.encode("set_ssid_pwd", "request", []) + b"name password"
    alignment = Alignment(codec)
    _cut(alignment, request, len(request) - 4)
    assert not alignment.held
