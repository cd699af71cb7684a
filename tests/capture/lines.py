"""Generate traffic to record, and read recordings back."""

from __future__ import annotations

import io
from collections.abc import Iterable
from typing import Literal, NamedTuple

from hypothesis import strategies as st

from cobotwire.capture import CaptureReader, CaptureWriter, Interface, Kind, Packet, Piece

Direction = Literal["sent", "received"]


class Chunk(NamedTuple):
    """One read or write of a client."""

    time: float
    direction: Direction
    data: bytes


FRAMES = [
    bytes.fromhex(frame)
    for frame in (
        "FE FE 02 20 FA",
        "FE FE 0E 20 00 01 FF FF 00 03 00 04 00 05 00 06 FA",
        "FE FE 03 12 01 FA",
        "FE FE 03 10 01 FA",
    )
]
DIRECTIONS: st.SearchStrategy[Direction] = st.sampled_from(["sent", "received"])
SPANS = st.one_of(st.sampled_from(FRAMES), st.binary(max_size=40), st.just(b"\xfe" * 7))


@st.composite
def chunks(draw: st.DrawFn) -> list[Chunk]:
    """Generate traffic of both directions, cut anywhere; times do not decrease."""
    made = []
    time = 1000.0
    for _ in range(draw(st.integers(0, 12))):
        whole = b"".join(draw(st.lists(SPANS, max_size=3)))
        direction = draw(DIRECTIONS)
        cuts = sorted(draw(st.lists(st.integers(0, len(whole)), max_size=4)))
        for start, end in zip([0, *cuts], [*cuts, len(whole)]):
            time += draw(st.sampled_from([0.0, 1e-6, 0.003, 0.1, 0.7]))
            made.append(Chunk(time, direction, whole[start:end]))
    return made


TIMES = st.integers(0, 2**64 - 1)


@st.composite
def packets(draw: st.DrawFn) -> Packet:
    """Generate any packet that our captures can hold."""
    data = draw(st.binary(max_size=60))
    kinds: list[Kind] = ["frame", "noise", "bytes"]
    kind = draw(st.sampled_from(kinds))
    start = draw(st.integers(0, 2**62))
    cuts = sorted(draw(st.sets(st.integers(1, len(data) - 1), max_size=3))) if len(data) > 2 else []
    ends = zip([0, *cuts], [*cuts, len(data)])
    pieces = [Piece(b - a, start + draw(st.integers(0, 2**40)) * (a > 0)) for a, b in ends]
    return Packet(
        start,
        draw(st.sampled_from(["sent", "received", "unknown"])),
        data,
        kind,
        draw(st.sampled_from(["no-header", "truncated"])) if kind == "noise" else "",
        tuple(pieces) if cuts else (),
    )


def written(packets: Iterable[Packet], *lines: str, finish: bool = True) -> bytes:
    """Return the bytes of a capture."""
    file = io.BytesIO()
    writer = CaptureWriter(file)
    for url in lines or ("/dev/ttyACM0",):
        writer.interface(Interface(url, "mycobot", 115200))
    for packet in packets:
        writer.packet(packet)
    if finish:
        writer.finish()
    return file.getvalue()


def reader(data: bytes) -> CaptureReader:
    return CaptureReader(io.BytesIO(data), "test.pcapng")


def line_bytes(packets: Iterable[Packet], direction: Direction) -> bytes:
    """Return all bytes of one direction."""
    return b"".join(packet.data for packet in packets if packet.direction == direction)
