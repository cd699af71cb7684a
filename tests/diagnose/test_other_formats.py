"""Check the laws of diagnosis for other frame formats than the document's."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

import field
import strategies
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame, Noise
from cobotwire.diagnose import DamagedFrame, Diagnoser, Finding, Item
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.table import Check, FrameFormat, Unsigned
from frame_format_tables import CRC16_MODBUS, SUM_OF_DATA

# Feetech: replies without an id.
NO_ID = FrameFormat(
    b"\xff\xff", b"", 40, Check("inverted-sum", "address"), (1, 7), reply_has_id=False
)
FORMATS = [
    FrameFormat(b"\xfe\xfe", b"", 40, CRC16_MODBUS),
    FrameFormat(b"\xfe\xfe", b"", 18, SUM_OF_DATA, (1, 2)),
    # Headers that also start text, a servo packet or NULs.
    FrameFormat(b"AT", b"\xfa", 18),
    FrameFormat(b"\xff\xff", b"\xfa", 18),
    FrameFormat(b"\0\0", b"\r", 18),
    # u-blox: ids of two bytes before a LEN of two bytes that counts the data only.
    FrameFormat(
        b"\xb5\x62",
        b"",
        60,
        Check("fletcher", "command", 2, "little"),
        layout=("command", "length"),
        counted=("data",),
        length_number=Unsigned(2, "little"),
        id_number=Unsigned(2),
    ),
    # Dynamixel 2.0: a header of four bytes, a wide LEN, an address.
    FrameFormat(
        b"\xff\xff\xfd\0", b"", 40, CRC16_MODBUS, (1, 2), length_number=Unsigned(2, "little")
    ),
    NO_ID,
]
CODECS = [
    codecs.load(table, name)
    for table in (TABLE_280, *(replace(TABLE, frame=format) for format in FORMATS))
    for name in ("reference", "native")
]


@st.composite
def streams(draw: st.DrawFn, codec: Codec) -> bytes:
    """Generate frames of the codec, complete or cut, between noise."""
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
def test_laws_of_diagnosis_hold_for_any_frame_format(codec: Codec, data: st.DataObject) -> None:
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
def test_truncated_frame_has_the_name_of_its_command(codec: Codec, lost: int) -> None:
    frame = codec.encode("get_angles", "reply", [(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)])
    found = _diagnose(codec, [frame[:-lost]])
    assert isinstance(found[0], DamagedFrame)
    if not codec.table.frame.reply_has_id:
        assert (found[0].command, found[0].id, found[0].offset) == (None, None, 0)
        return
    names = [command.name for command in codec.table.commands if command.id == found[0].id]
    assert (found[0].command, found[0].offset) == (" or ".join(names), 0)
    assert "get_angles" in names
    assert not any(isinstance(item, Frame | Noise) for item in found)


@pytest.mark.parametrize("name", ["reference", "native"])
def test_frames_of_formats_without_ids_in_replies_are_described(name: codecs.CodecName) -> None:
    codec = codecs.load(replace(TABLE, frame=NO_ID), name)
    whole = codec.encode("get_angles", "reply", [(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)], address=7)
    sizes = {variant.size for command in TABLE.commands for variant in command.reply}
    unlisted = NO_ID.enclose(0, bytes(min(set(range(1, 20)) - sizes)), 7, "reply")
    request = codec.encode("send_angle", "request", [1, 10.0, 50])
    for stream, described in (
        (whole[:-3], "damaged frame: its end or check is wrong"),
        (whole[:-1] + b"\0", "damaged frame: its end or check is wrong"),
        (unlisted, "damaged frame: its LEN is wrong"),
        (request, "a request, send_angle: an echo, or another host"),
    ):
        found, frame = _diagnose(codec, [stream + whole])
        assert isinstance(found, Finding)
        assert (found.describe(), found.data) == (described, stream)
        assert isinstance(frame, Frame)
    # A host that listens to requests reads their ids.
    framer, diagnoser = codec.framer("request"), Diagnoser(codec, "request")
    [damaged] = diagnoser.feed([*framer.feed(request[:-1]), *framer.flush()]) + diagnoser.flush()
    assert isinstance(damaged, DamagedFrame)
    assert damaged.command == "send_angle"
