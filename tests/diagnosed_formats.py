"""Codecs of other frame formats than the document's, and streams of them, to diagnose."""

from __future__ import annotations

from hypothesis import strategies as st

import field
from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec
from cobotwire.editions.mycobot import TABLE
from cobotwire.editions.mycobot280 import TABLE as TABLE_280
from cobotwire.protocol.table import Check, FrameFormat, Unsigned
from json_tables import CRC16_MODBUS, SUM_OF_DATA

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
    for table in (TABLE_280, *(TABLE._replace(frame=format) for format in FORMATS))
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
