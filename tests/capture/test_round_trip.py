"""What is written is what is read."""

from __future__ import annotations

import io
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from capture.lines import packets, reader, written
from cobotwire.capture import CaptureWriter, Interface, Packet, Piece, is_capture
from cobotwire.errors import CaptureError


@given(st.lists(packets(), max_size=8))
def test_packets_come_back_as_they_were(given_packets: list[Packet]) -> None:
    data = written(given_packets)
    assert is_capture(data[:12])
    capture = reader(data)
    assert list(capture) == given_packets
    assert capture.interfaces == [Interface("/dev/ttyACM0", "mycobot", 115200)]
    assert capture.application == "cobotwire"
    assert capture.finished
    assert capture.truncated_at is None


def test_several_lines_keep_their_packets_apart() -> None:
    given_packets = [Packet(5, "sent", b"a", interface=1), Packet(6, "heard", b"b", interface=0)]
    capture = reader(written(given_packets, "/dev/ttyUSB0", "socket://arm:9000"))
    assert list(capture) == given_packets
    assert [line.url for line in capture.interfaces] == ["/dev/ttyUSB0", "socket://arm:9000"]


@pytest.mark.parametrize("words", ["", "é" * 40_000, "\udc80 no text", "a; noise x"])
def test_any_name_is_written_as_text(words: str) -> None:
    file = io.BytesIO()
    CaptureWriter(file, words).interface(Interface(words, words, 0))
    capture = reader(file.getvalue())
    assert list(capture) == []
    assert capture.application == words.encode("utf-8", "replace")[: 2 * 32767].decode()


def test_captures_after_one_another_are_one_capture() -> None:
    first, second = Packet(1, "sent", b"one"), Packet(2, "heard", b"two")
    capture = reader(written([first]) + written([second]))
    assert list(capture) == [first, second._replace(interface=1)]
    assert len(capture.interfaces) == 2


def test_a_capture_without_its_end_is_not_finished() -> None:
    capture = reader(written([Packet(1, "sent", b"x")], finish=False))
    assert len(list(capture)) == 1
    assert not capture.finished
    assert capture.truncated_at is None


# What other programs write: numbers the other way round, other resolutions, no options.
def block(order: str, kind: int, body: bytes) -> bytes:
    size = struct.pack(order + "I", len(body) + 12)
    return struct.pack(order + "I", kind) + size + body + size


def foreign(
    order: str, options: bytes = b"", stamp: int = 1_500_000, link_type: int = 147, kind: int = 6
) -> bytes:
    section = struct.pack(order + "IHHq", 0x1A2B3C4D, 1, 0, -1)
    interface = struct.pack(order + "HHI", link_type, 0, 0) + options
    packet = struct.pack(order + "IIIII", 0, stamp >> 32, stamp & 0xFFFFFFFF, 3, 3) + b"abc\0"
    other = block(order, 0x0BAD, b"what nobody here knows..")
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
def test_other_programs_captures_are_read(
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


def test_a_capture_of_something_else_is_refused() -> None:
    with pytest.raises(CaptureError, match="link type 1, which is no serial line"):
        list(reader(foreign("<", link_type=1)))


@pytest.mark.parametrize("kind", [2, 3])
def test_packets_that_tell_too_little_are_refused(kind: int) -> None:
    with pytest.raises(CaptureError, match="neither time nor direction"):
        list(reader(foreign("<", kind=kind)))


@pytest.mark.parametrize("comment", ["a note of mine", "in pieces: 1 bytes at +0 ns", "noisy"])
def test_a_comment_of_somebody_else_changes_nothing(comment: str) -> None:
    from cobotwire.capture.packet import with_comment

    packet = Packet(1, "sent", b"abc")
    assert with_comment(packet, comment) == packet


def test_pieces_and_noise_are_told_in_words() -> None:
    from cobotwire.capture.packet import comment_of

    pieces = (Piece(1, 10), Piece(2, 110))
    packet = Packet(10, "heard", b"abc", "noise", "no-header", pieces)
    assert comment_of(packet) == "noise no-header; in pieces: 1 bytes at +0 ns, 2 bytes at +100 ns"
