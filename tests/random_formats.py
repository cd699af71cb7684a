"""Random frame formats: header, layout, widths, byte order, check, and what LEN counts."""

from __future__ import annotations

from functools import cache

from hypothesis import strategies as st

from cobotwire.protocol.checks import ByteOrder, Check, CoveredFrom
from cobotwire.protocol.frame_format import CountedPart, FixedPart, FrameFormat, Unsigned
from cobotwire.protocol.table import Crc
from cobotwire_codegen.catalogue import CRCS, WIDTHS

LAYOUTS: st.SearchStrategy[tuple[FixedPart, ...]] = st.sampled_from(
    [
        ("address", "length", "command"),
        ("length", "address", "command"),
        ("command", "address", "length"),
        ("address", "command", "length"),
    ]
)
COUNTED: list[CountedPart] = ["header", "address", "length", "command", "check", "footer"]
# Constants, as in random_tables.
ORDERS: st.SearchStrategy[ByteOrder] = st.sampled_from(["big", "little"])
STARTS: st.SearchStrategy[CoveredFrom] = st.sampled_from(
    ["header", "address", "length", "command", "data"]
)
NAMES = st.sampled_from(sorted(WIDTHS)) | st.sampled_from(sorted(CRCS))
BYTES = st.sampled_from([0xFA, 0xFE, 0])
FOOTERS = BYTES.map(lambda value: bytes([value]))
HEADERS = st.sampled_from([b"\xfe\xfe", b"\xb5b", b"\xff\xff\xfd\0"]) | st.lists(
    BYTES, min_size=1, max_size=4
).map(bytes)
ADDRESSES = st.sampled_from([(), (), (1, 0), (0xFE,), tuple(range(254))])
WIDE = st.sampled_from([1, 1, 2])


@cache
@st.composite
def checks(draw: st.DrawFn) -> Check:
    """Draw a check of the catalogue."""
    start, order, name = draw(STARTS), draw(ORDERS), draw(NAMES)
    if name in WIDTHS:
        return Check(name, start, draw(st.sampled_from(WIDTHS[name])), order)  # type: ignore[arg-type]
    return Check("crc", start, -(-CRCS[name].width // 8), order, Crc(*CRCS[name][:-1]))


@cache
@st.composite
def frame_formats(draw: st.DrawFn) -> FrameFormat:
    """Draw any frame format; most have a header and addresses that are found in other bytes too."""
    check = draw(st.none() | checks())
    footer = draw(st.binary(max_size=2) if check else FOOTERS)
    header, layout = draw(HEADERS), draw(LAYOUTS)
    counted = [part for part in COUNTED if draw(st.booleans())]
    return FrameFormat(
        header,
        footer,
        draw(st.integers(2, 40)),
        check,
        draw(ADDRESSES),
        layout,
        (*counted, "data"),
        Unsigned(draw(WIDE), draw(ORDERS)),
        Unsigned(draw(WIDE), draw(ORDERS)),
        reply_has_id=layout[-1] != "command" or draw(st.booleans()),
    )
