"""The laws of diagnosis, for frames of other shapes than the document's."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

import field
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame, Noise
from cobotwire.diagnose import DamagedFrame, Diagnoser, Finding, Item
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.table import FrameFormat

FORMATS = [
    FrameFormat(b"\xfe\xfe", b"", 40, "crc16-modbus"),
    FrameFormat(b"\xfe\xfe", b"", 18, "sum", (1, 2)),
    # Headers with which text, a servo packet or NULs also start.
    FrameFormat(b"AT", b"\xfa", 18),
    FrameFormat(b"\xff\xff", b"\xfa", 18),
    FrameFormat(b"\0\0", b"\r", 18),
]
CODECS = [
    codecs.load(table, name)
    for table in (TABLE_280, *(replace(TABLE, frame=format) for format in FORMATS))
    for name in ("reference", "native")
]


@st.composite
def streams(draw: st.DrawFn, codec: Codec) -> bytes:
    """Frames of the codec, whole, cut or spoilt, between field noise."""
    frames = st.sampled_from(
        [
            codec.encode("get_angles", "reply", [(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)]),
            codec.encode("get_angles", "request", []),
            codec.encode("send_angle", "request", [1, 10.0, 50]),
        ]
    )
    cut = st.builds(lambda data, at: data[: at % len(data)], frames, st.integers(0))
    pieces = st.one_of(frames, cut, field.noise(), st.just(codec.table.frame.header))
    return b"".join(draw(st.lists(pieces, max_size=8)))


def _diagnose(codec: Codec, chunks: list[bytes]) -> list[Item]:
    framer, diagnoser = codec.framer("reply"), Diagnoser(codec, "reply")
    items = [item for chunk in chunks for item in diagnoser.feed(framer.feed(chunk))]
    return items + diagnoser.feed(framer.flush()) + diagnoser.flush()


@given(st.sampled_from(CODECS), st.data())
def test_the_laws_hold_for_frames_of_any_shape(codec: Codec, data: st.DataObject) -> None:
    stream = data.draw(streams(codec))
    items = _diagnose(codec, [stream])
    spans = sorted(
        span
        for item in items
        for span in (item.spans if isinstance(item, Finding) else [(item.offset, item.data)])
    )
    assert b"".join(span[1] for span in spans) == stream
    assert all(a[0] + len(a[1]) == b[0] for a, b in pairwise(spans))
    assert _diagnose(codec, data.draw(strategies.chunked(stream))) == items
    assert _diagnose(codec, [bytes([byte]) for byte in stream]) == items


@given(st.sampled_from(CODECS), st.integers(1, 6))
def test_a_cut_frame_is_named(codec: Codec, lost: int) -> None:
    frame = codec.encode("get_angles", "reply", [(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)])
    found = _diagnose(codec, [frame[:-lost]])
    assert isinstance(found[0], DamagedFrame)
    assert (found[0].command, found[0].offset) == ("get_angles", 0)
    assert not any(isinstance(item, Frame | Noise) for item in found)
