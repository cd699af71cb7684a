"""Write captures and read them back; read captures of other programs."""

from __future__ import annotations

import io
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from capture.lines import packets, reader, written
from cobotwire.capture import CaptureWriter, Interface, Packet, is_capture
from cobotwire.protocol.errors import CaptureError


@given(st.lists(packets(), max_size=8))
def test_written_packets_are_read_back_unchanged(given_packets: list[Packet]) -> None:
    data = written(given_packets)
    assert is_capture(data[:12])
    capture = reader(data)
    assert list(capture) == given_packets
    assert capture.interfaces == [Interface("/dev/ttyACM0", "mycobot", 115200)]
    assert capture.application == "cobotwire"
    assert capture.finished
    assert capture.truncated_at is None


@pytest.mark.parametrize("words", ["", "é" * 40_000, "\udc80 no text", "a; noise x"])
def test_any_name_is_written_as_valid_text(words: str) -> None:
    file = io.BytesIO()
    CaptureWriter(file, words).interface(Interface(words, words, 0))
    capture = reader(file.getvalue())
    assert list(capture) == []
    assert capture.application == words.encode("utf-8", "replace")[: 2 * 32767].decode()


# Other programs write the other byte order, other resolutions, and no options.
def block(order: str, kind: int, body: bytes) -> bytes:
    size = struct.pack(order + "I", len(body) + 12)
    return struct.pack(order + "I", kind) + size + body + size


def foreign(
    order: str, options: bytes = b"", stamp: int = 1_500_000, link_type: int = 147, kind: int = 6
) -> bytes:
    section = struct.pack(order + "IHHq", 0x1A2B3C4D, 1, 0, -1)
    interface = struct.pack(order + "HHI", link_type, 0, 0) + options
    packet = struct.pack(order + "IIIII", 0, stamp >> 32, stamp & 0xFFFFFFFF, 3, 3) + b"abc\0"
    other = block(order, 0x0BAD, b"a block of unknown type.")
    parts = [(0x0A0D0D0A, section), (1, interface), (kind, packet)]
    return other.join(block(order, kind, body) for kind, body in parts)


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(
    ("resolution", "offset", "nanoseconds"),
    [
        (None, None, 1_500_000_000),
        (6, None, 1_500_000_000),
        (9, None, 1_500_000),
        (12, None, 1_500),
        (3, 7, 1_507_000_000_000),
        (0x80 | 10, -1, 1_500_000 * 1_000_000_000 // 1024 - 1_000_000_000),
        (127, None, 0),
    ],
)
def test_captures_of_other_programs_are_read(
    order: str, resolution: int | None, offset: int | None, nanoseconds: int
) -> None:
    options = b""
    if resolution is not None:
        options += struct.pack(order + "HHBxxx", 9, 1, resolution)
    if offset is not None:
        options += struct.pack(order + "HHq", 14, 8, offset)
    data = foreign(order, options)
    assert is_capture(data)
    assert list(reader(data)) == [Packet(nanoseconds, "unknown", b"abc", "bytes")]


def test_capture_of_another_link_type_is_rejected() -> None:
    with pytest.raises(CaptureError, match="link type 1 is not that of a serial recording"):
        list(reader(foreign("<", link_type=1)))


@pytest.mark.parametrize("kind", [2, 3])
def test_packets_without_time_and_direction_are_rejected(kind: int) -> None:
    with pytest.raises(CaptureError, match="neither a time nor a direction"):
        list(reader(foreign("<", kind=kind)))
