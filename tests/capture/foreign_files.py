"""Generate pcapng files as other programs and hostile ones write them."""

from __future__ import annotations

import struct

from hypothesis import strategies as st

from capture.lines import FRAMES
from cobotwire.capture import block_encoding as blocks

PAYLOADS = st.one_of(
    st.sampled_from(FRAMES),
    st.lists(st.sampled_from(FRAMES), min_size=2, max_size=4).map(b"".join),
    st.tuples(st.sampled_from(FRAMES), st.integers(0, 17)).map(lambda it: it[0][: it[1]]),
    st.tuples(st.sampled_from(FRAMES), st.integers(0, 17)).map(lambda it: it[0][it[1] :]),
    st.binary(max_size=9),
    st.just(b"\xfe\xfe\x0e\x20"),
)
STEPS = st.sampled_from([0, 0, 1, 1000, 10**6, 499_999_999, 500_000_000, 10**9, -(10**9)])
RESOLUTIONS = st.sampled_from([None, b"", b"\x09", b"\x06", b"\x00", b"\x0c", b"\x9e", b"\xff"])


class Writer:
    """Writes blocks in one byte order."""

    def __init__(self, order: str) -> None:
        self.order = order

    def pack(self, format: str, *numbers: int) -> bytes:
        return struct.pack(self.order + format, *numbers)

    def block(self, kind: int, body: bytes) -> bytes:
        body += bytes(-len(body) % 4)
        size = self.pack("I", len(body) + 12)
        return self.pack("I", kind) + size + body + size

    def options(self, options: list[tuple[int, bytes]], end: bool) -> bytes:
        made = b"".join(
            self.pack("HH", code, len(value)) + value + bytes(-len(value) % 4)
            for code, value in options
        )
        return made + (self.pack("HH", 0, 0) if end else b"")


@st.composite
def sections(draw: st.DrawFn) -> bytes:
    """Generate a section with its interfaces, packets, statistics and unknown blocks."""
    writer = Writer(draw(st.sampled_from("<>")))
    head = writer.pack("IHHq", blocks.BYTE_ORDER_MAGIC, 1, draw(st.integers(0, 9)), -1)
    application = draw(st.sampled_from([[], [(4, b"cobotwire")], [(4, b"other\xff\0")]]))
    made = [writer.block(blocks.SECTION, head + writer.options(application, draw(st.booleans())))]
    interfaces = draw(st.integers(1, 3))
    made += [draw(interface(writer)) for _ in range(interfaces)]
    time = draw(st.sampled_from([0, 10**9, 10**18]))
    for _ in range(draw(st.integers(0, 10))):
        time = max(0, time + draw(STEPS))
        made.append(draw(packet(writer, interfaces, time)))
        if draw(st.integers(0, 9)) == 0:
            made.append(writer.block(draw(st.integers(7, 20)), draw(st.binary(max_size=9))))
    if draw(st.booleans()):
        index = st.integers(0, interfaces - 1)
        made += [
            writer.block(blocks.STATISTICS, writer.pack("III", draw(index), 0, 0))
            for _ in range(interfaces)
        ]
    return b"".join(made)


@st.composite
def interface(draw: st.DrawFn, writer: Writer) -> bytes:
    """Generate the block of an interface."""
    options = [(2, draw(st.sampled_from([b"/dev/a", b"\xff\xfe", b"a\0\0"])))]
    options += [(3, draw(st.sampled_from([b"edition mycobot280", b"edition ?", b"text"])))]
    options += [(8, draw(st.binary(min_size=7, max_size=8)))] * draw(st.booleans())
    resolution = draw(RESOLUTIONS)
    options += [] if resolution is None else [(9, resolution)]
    if draw(st.integers(0, 3)) == 0:
        seconds = draw(st.sampled_from([0, -1, 1, -(10**9), 2**40]))
        options.append((14, writer.pack("q", seconds)))
    link_type = draw(st.sampled_from([159, 159, 147, 162]))
    head = writer.pack("HHI", link_type, 0, 0)
    return writer.block(blocks.INTERFACE, head + writer.options(options, draw(st.booleans())))


@st.composite
def packet(draw: st.DrawFn, writer: Writer, interfaces: int, time: int) -> bytes:
    """Generate a packet block, sometimes with pieces in its comment, some of them wrong."""
    data = draw(PAYLOADS)
    options = []
    if draw(st.integers(0, 3)) == 0:
        options.append((1, draw(comment(len(data)))))
    options += draw(
        st.sampled_from(
            [[], [(2, writer.pack("I", 1))], [(2, writer.pack("I", 2))], [(2, b"")], [(2, b"\2")]]
        )
    )
    head = writer.pack("I", draw(st.integers(0, interfaces - 1)))
    head += writer.pack("IIII", time >> 32, time & 0xFFFFFFFF, len(data), len(data))
    padded = data + bytes(-len(data) % 4)
    return writer.block(blocks.PACKET, head + padded + writer.options(options, draw(st.booleans())))


@st.composite
def comment(draw: st.DrawFn, size: int) -> bytes:
    """Generate a comment: a note, pieces that may add up to the size, or both."""
    parts = []
    for _ in range(draw(st.integers(1, 3))):
        cuts = sorted(draw(st.lists(st.integers(0, size), max_size=3)))
        sizes = [end - start for start, end in zip([0, *cuts], [*cuts, size])]
        late = st.sampled_from([0, 1, 10**6, 7 * 10**8, 10**18, 10**19 - 1, 10**19])
        pieces = [f"{size} bytes at +{draw(late)} ns" for size in sizes]
        joint = draw(st.sampled_from([", ", " ", "", "9", "\N{ARABIC-INDIC DIGIT ONE}", "x 5 "]))
        mark = draw(st.sampled_from(["in pieces: ", "in pieces: ", "in pieces:", "noise x; "]))
        parts.append(mark + joint.join(pieces))
    text = draw(st.sampled_from(["; ", ";", " "])).join(parts).encode()
    return text + draw(st.sampled_from([b"", b"\0", b"\xe2\x82", b"; bytes"]))


files = st.lists(sections(), min_size=1, max_size=2).map(b"".join)


@st.composite
def damaged_files(draw: st.DrawFn) -> bytes:
    """Generate a file with some bytes changed, removed or cut off."""
    whole = bytearray(draw(files))
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(whole) - 1))
        kind = draw(st.sampled_from(["byte", "byte", "number", "remove", "cut"]))
        if kind == "byte":
            whole[at] = draw(st.integers(0, 255))
        elif kind == "number":
            at -= at % 4
            whole[at : at + 4] = draw(
                st.sampled_from([bytes(4), b"\xff" * 4, b"\0\1\0\0", b"\x0c\0\0\0", b"\6\0\0\0"])
            )
        elif kind == "remove":
            del whole[at : at + draw(st.integers(1, 40))]
        else:
            del whole[at:]
        whole = whole or bytearray(1)
    return bytes(whole)
