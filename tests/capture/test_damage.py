"""Read captures that are truncated or damaged, and files that are not captures."""

from __future__ import annotations

import io
import time
import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from capture.lines import packets, reader, written
from cobotwire.capture import CaptureReader, Packet, read
from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.damage import LARGEST_BLOCK
from cobotwire.protocol.errors import CaptureError, UsageError

SAMPLE = [Packet(1_000, "sent", b"request"), Packet(2_000, "received", b"reply!!", "noise", "x")]


def read_all(data: bytes) -> tuple[list[Packet], CaptureError | None]:
    """Return the packets and the error; check that iteration ends with the error."""
    capture = reader(data)
    found: list[Packet] = []
    try:
        found.extend(capture)
    except CaptureError as error:
        assert list(capture) == []
        return found, error
    return found, None


@given(st.lists(packets(), max_size=4), st.data())
def test_truncated_capture_is_read_up_to_its_last_complete_block(
    given_packets: list[Packet], data: st.DataObject
) -> None:
    # The next packet begins where a capture of the packets before it ends.
    whole = written(given_packets)
    ends = [len(written(given_packets[:n], finish=False)) for n in range(len(given_packets) + 1)]
    cut = data.draw(st.integers(0, len(whole) - 1))
    capture = reader(whole[:cut])
    count = sum(end <= cut for end in ends[1:])
    assert list(capture) == given_packets[:count]
    assert not capture.finished
    between_blocks = {0, len(blocks.section("cobotwire")), *ends}
    assert (capture.truncated_at is None) == (cut in between_blocks)
    if capture.truncated_at is not None:
        assert capture.truncated_at < cut
        # Everything before that place is complete.
        again = reader(whole[: capture.truncated_at])
        assert list(again) == given_packets[:count]
        assert again.truncated_at is None


@settings(max_examples=500)
@given(st.data())
def test_damaged_capture_is_read_or_rejected_with_the_offset(data: st.DataObject) -> None:
    whole = bytearray(written(SAMPLE))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(whole) - 1))
        whole[at] = data.draw(st.integers(0, 255))
    found, error = read_all(bytes(whole))
    assert len(found) <= len(SAMPLE)
    if error is not None:
        assert 0 <= error.offset < len(whole)
        assert error.offset % 4 == 0
        assert f"(at byte {error.offset})" in str(error)


@pytest.mark.parametrize("size", [0, 8, 11, 13, LARGEST_BLOCK + 4, 2**32 - 4])
def test_block_with_an_impossible_length_is_rejected_at_its_offset(size: int) -> None:
    whole = written(SAMPLE)
    place = len(written(SAMPLE[:1], finish=False))
    damaged = whole[: place + 4] + size.to_bytes(4, "little") + whole[place + 8 :]
    capture = reader(damaged)
    assert next(capture) == SAMPLE[0]
    with pytest.raises(CaptureError, match="damaged") as caught:
        next(capture)
    assert caught.value.offset == place


def test_block_with_a_large_length_costs_neither_time_nor_memory() -> None:
    whole = written(SAMPLE, finish=False)
    place = len(written(SAMPLE[:1], finish=False))
    damaged = whole[: place + 4] + LARGEST_BLOCK.to_bytes(4, "little") + whole[place + 8 :]
    tracemalloc.start()
    started = time.monotonic()
    capture = reader(damaged)
    assert list(capture) == SAMPLE[:1]
    assert capture.truncated_at == place
    assert time.monotonic() - started < 1.0
    assert tracemalloc.get_traced_memory()[1] < 1_000_000
    tracemalloc.stop()


def test_reading_another_file_raises_capture_error() -> None:
    with pytest.raises(
        CaptureError, match=r"test.pcapng: the file is not a pcapng recording; .* \(at byte 0\)"
    ):
        list(reader(b"FE FE 02 20 FA\n"))


def test_missing_file_raises_usage_error() -> None:
    with pytest.raises(UsageError, match="no such file"):
        read("/no/such/file.pcapng")
    with pytest.raises(UsageError, match="null byte"):
        read("a\0b")


class Drip(io.RawIOBase):
    """A file that returns one byte per read, as a pipe may."""

    def __init__(self, data: bytes) -> None:
        self._rest = data

    def read(self, size: int = -1) -> bytes:
        taken, self._rest = self._rest[:1], self._rest[1:]
        return taken


def test_capture_is_read_from_a_slow_pipe() -> None:
    assert list(CaptureReader(Drip(written(SAMPLE)))) == SAMPLE
