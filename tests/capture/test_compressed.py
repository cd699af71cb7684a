"""Compressed captures give the same packets as plain ones, in bounded memory, even if damaged."""

from __future__ import annotations

import gzip
import tracemalloc
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import zstandard

from capture.lines import FRAMES, reader, written
from cobotwire import codec
from cobotwire.capture import Packet, read
from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.captured_columns import CapturedColumns
from cobotwire.capture.columns import read_batches, read_columns
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import CaptureError

PACKETS = [Packet(10**18 + n * 10**7, "received", FRAMES[1]) for n in range(2_000)]
PLAIN = written(PACKETS)
NATIVE = codec.load(TABLE)


def gzipped(data: bytes) -> bytes:
    return gzip.compress(data, mtime=0)


COMPRESS = pytest.mark.parametrize("compress", [gzipped, zstandard.compress], ids=["gz", "zst"])
Compress = Callable[[bytes], bytes]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "arm.pcapng"


@COMPRESS
def test_compressed_capture_is_read_like_the_capture(compress: Compress, path: Path) -> None:
    path.write_bytes(compress(PLAIN))
    assert list(read(path)) == PACKETS
    found = read_columns(path, NATIVE)
    assert found.rows("get_angles").time.tolist() == [packet.time_ns for packet in PACKETS]
    assert found.finished
    assert found.size == len(PLAIN)


@COMPRESS
def test_cut_compressed_capture_is_truncated(compress: Compress, path: Path) -> None:
    data = compress(PLAIN)
    path.write_bytes(data[: len(data) // 2])
    found = read_columns(path, NATIVE)
    assert not found.finished
    assert found.error is None
    packets = list(read(path))
    assert len(found) == len(packets) < len(PACKETS)
    assert packets == PACKETS[: len(packets)]


@COMPRESS
def test_damaged_compression_is_reported_after_everything_before_it(
    compress: Compress, path: Path
) -> None:
    # The second part is damaged: neither format can be read beyond it.
    path.write_bytes(compress(PLAIN[:64_000]) + b"\x1f\x8b\x08damage")
    with pytest.raises(CaptureError, match="compressed data is damaged") as caught:
        read_columns(path, NATIVE)
    assert caught.value.offset == 64_000
    found = read_columns(path, NATIVE, damaged="keep")
    assert str(found.error) == str(caught.value)
    assert len(found) == len(list(reader(PLAIN[:64_000])))
    batches = before_error(read_batches(path, NATIVE, piece=10_000))
    assert sum(map(len, batches)) == len(found)


def before_error(batches: Iterator[CapturedColumns]) -> Iterator[CapturedColumns]:
    """Yield batches; check that an error ends them."""
    with pytest.raises(CaptureError):
        yield from batches


@COMPRESS
def test_decompression_bomb_does_not_grow_memory(compress: Compress, path: Path) -> None:
    filler = blocks._block(0x0BAD, bytes(1 << 20))
    path.write_bytes(compress(PLAIN + filler * 80))
    assert path.stat().st_size < 500_000
    tracemalloc.start()
    found = sum(len(batch) for batch in read_batches(path, NATIVE))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found == len(PACKETS)
    assert peak < 50_000_000


def test_zstd_that_refers_too_far_back_is_rejected(path: Path) -> None:
    parameters = zstandard.ZstdCompressionParameters(window_log=29, compression_level=1)
    compressor = zstandard.ZstdCompressor(compression_params=parameters).compressobj()
    path.write_bytes(compressor.compress(PLAIN) + compressor.flush())
    with pytest.raises(CaptureError, match="memory"):
        list(read(path))


def test_gzip_with_a_wrong_sum_is_rejected_after_its_content(path: Path) -> None:
    data = bytearray(gzipped(PLAIN))
    data[-8] ^= 1
    path.write_bytes(data)
    assert zlib.crc32(PLAIN) != int.from_bytes(data[-8:-4], "little")
    with pytest.raises(CaptureError, match="check"):
        read_columns(path, NATIVE)
