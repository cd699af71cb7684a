"""Captures that end in the middle, or are no captures."""

from __future__ import annotations

import io
import time
import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from capture.lines import packets, reader, written
from cobotwire.capture import CaptureReader, Packet, is_capture, read
from cobotwire.capture.parse import LARGEST_BLOCK
from cobotwire.errors import CaptureError, UsageError

SAMPLE = [Packet(1_000, "sent", b"question"), Packet(2_000, "heard", b"answer!", "noise", "x")]


def read_all(data: bytes) -> tuple[list[Packet], CaptureError | None]:
    """The packets, and the error behind which there must be nothing."""
    capture = reader(data)
    found: list[Packet] = []
    try:
        found.extend(capture)
    except CaptureError as error:
        assert list(capture) == []
        return found, error
    return found, None


@given(st.lists(packets(), max_size=4), st.data())
def test_what_is_cut_anywhere_reads_up_to_its_last_whole_block(
    given_packets: list[Packet], data: st.DataObject
) -> None:
    # A whole capture of the first few ends where the next packet begins.
    whole = written(given_packets)
    ends = [len(written(given_packets[:n], finish=False)) for n in range(len(given_packets) + 1)]
    cut = data.draw(st.integers(0, len(whole) - 1))
    capture = reader(whole[:cut])
    count = sum(end <= cut for end in ends[1:])
    assert list(capture) == given_packets[:count]
    assert not capture.finished
    if capture.truncated_at is not None:
        assert capture.truncated_at < cut
        # Up to there it is whole.
        again = reader(whole[: capture.truncated_at])
        assert list(again) == given_packets[:count]
        assert again.truncated_at is None


@settings(max_examples=500)
@given(st.data())
def test_a_damaged_capture_is_read_or_refused_with_the_place(data: st.DataObject) -> None:
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


@settings(max_examples=500)
@given(st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    found, error = read_all(data)
    assert found == []
    assert error is None or 0 <= error.offset <= len(data)


@pytest.mark.parametrize("size", [0, 8, 11, 13, LARGEST_BLOCK + 4, 2**32 - 4])
def test_a_length_that_cannot_be_is_refused_at_its_place(size: int) -> None:
    whole = written(SAMPLE)
    place = len(written(SAMPLE[:1], finish=False))
    damaged = whole[: place + 4] + size.to_bytes(4, "little") + whole[place + 8 :]
    capture = reader(damaged)
    assert next(capture) == SAMPLE[0]
    with pytest.raises(CaptureError, match="damaged") as caught:
        next(capture)
    assert caught.value.offset == place


def test_a_great_length_costs_neither_time_nor_memory() -> None:
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


@pytest.mark.parametrize("data", [b"FE FE 02 20 FA\n", b"\n\r\r\n" + bytes(30), b"\x0a"])
def test_what_is_no_capture_is_not_taken_for_one(data: bytes) -> None:
    assert not is_capture(data)


def test_a_file_that_is_no_capture_says_so() -> None:
    with pytest.raises(CaptureError, match=r"test.pcapng: no pcapng file.*\(at byte 0\)"):
        list(reader(b"FE FE 02 20 FA\n"))


def test_a_file_that_is_not_there_is_the_callers_fault() -> None:
    with pytest.raises(UsageError, match="No such file"):
        read("/no/such/file.pcapng")
    with pytest.raises(UsageError, match="a file that can be read"):
        read("a\0b")


def test_an_empty_file_is_an_empty_capture_that_is_not_finished() -> None:
    capture = reader(b"")
    assert list(capture) == []
    assert not capture.finished


class Drip(io.RawIOBase):
    """A file that gives a byte at a time, as a pipe may."""

    def __init__(self, data: bytes) -> None:
        self._rest = data

    def read(self, size: int = -1) -> bytes:
        taken, self._rest = self._rest[:1], self._rest[1:]
        return taken


def test_a_pipe_that_gives_little_at_a_time_is_read_all_the_same() -> None:
    assert list(CaptureReader(Drip(written(SAMPLE)))) == SAMPLE  # type: ignore[arg-type]
