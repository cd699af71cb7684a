"""Decompress gzip and zstd piece by piece, in bounded memory whatever the data expands to."""

from __future__ import annotations

import sys
import zlib
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Literal

from cobotwire.protocol.errors import CaptureError, UsageError

Compression = Literal["gzip", "zstd"]

_MAGIC: dict[bytes, Compression] = {b"\x1f\x8b\x08": "gzip", b"\x28\xb5\x2f\xfd": "zstd"}
# Compressed bytes to decompress at a time. gzip may expand one byte to 1,032 bytes, and zstd a
# four-byte block to 128 KiB. So no step makes more than 17 MB.
_SLICES: dict[Compression, int] = {"gzip": 1 << 12, "zstd": 1 << 9}
# The longest distance that zstd may refer back to, as a power of two: the limit of its own tool.
# The decompressor buffers that number of bytes.
_WINDOW = 27
# The error of compressed data that ends too early; it follows the name of the file.
CUT_OFF = "has compressed data that is cut off"


class DamagedCompression(ValueError):
    """The compressed data is damaged."""


def compression_of(first_bytes: bytes) -> Compression | None:
    """Return how data that begins with these bytes (4 suffice) is compressed, if it is."""
    kinds = (kind for magic, kind in _MAGIC.items() if first_bytes.startswith(magic))
    return next(kinds, None)


class Decompressed(Iterator[bytes]):
    """Yields the decompressed bytes of blocks, in pieces that are not empty."""

    def __init__(
        self, blocks: Iterable[bytes], compression: Compression, name: str, missing: list[str]
    ) -> None:
        """Decompress ``blocks``; ``name`` is the input's, for messages.

        If the data ends too early, ``CUT_OFF`` is added to ``missing`` at its end.

        Raises:
            UsageError: zstd is not installed.
        """
        self._missing = missing
        start = _gzip_part if compression == "gzip" else _zstd_parts(name)
        self._pieces = self._expand(blocks, start, _SLICES[compression])

    def __next__(self) -> bytes:
        """Return the next piece.

        Raises:
            DamagedCompression: the compressed data is damaged.
        """
        return next(self._pieces)

    def _expand(
        self, blocks: Iterable[bytes], start: Callable[[], Any], size: int
    ) -> Iterator[bytes]:
        part, complete = start(), False
        for block in blocks:
            for at in range(0, len(block), size):
                rest = block[at : at + size]
                while rest:
                    if part.eof:
                        # Programs that append write one compressed part after another; others pad
                        # the last one with zeros.
                        rest = rest.lstrip(b"\0")
                        part = start() if rest else part
                        continue
                    if data := _expanded(part, rest):
                        yield data
                    complete = part.eof
                    rest = part.unused_data
        if not complete:
            self._missing.append(CUT_OFF)


def decompressed(
    blocks: Iterable[bytes], compression: Compression, name: str, missing: list[str]
) -> Iterator[bytes]:
    """Yield the decompressed bytes of a capture; see :class:`Decompressed` for ``missing``.

    Raises:
        UsageError: zstd is not installed.
        CaptureError: the compressed data is damaged; the offset counts decompressed bytes.
    """
    offset = 0
    try:
        for piece in Decompressed(blocks, compression, name, missing):
            yield piece
            offset += len(piece)
    except DamagedCompression as error:
        why = f"the compressed data is damaged: {error}"
        raise CaptureError(name, offset, why) from error


def _expanded(part: Any, data: bytes) -> bytes:
    try:
        return bytes(part.decompress(data))
    # Each library has errors of its own.
    except Exception as error:
        raise DamagedCompression(str(error)) from error


def _gzip_part() -> Any:
    """Return a decompressor for one part of a gzip file, which checks the sum at its end."""
    return zlib.decompressobj(wbits=31)


def _zstd_parts(name: str) -> Callable[[], Any]:
    """Return a function that makes a decompressor for one part of a zstd file."""
    if sys.version_info >= (3, 14):
        from compression import zstd

        options = {zstd.DecompressionParameter.window_log_max: _WINDOW}
        return lambda: zstd.ZstdDecompressor(options=options)
    try:
        import zstandard
    except ImportError as error:
        message = f"reading {name} needs zstandard: pip install 'cobotwire[zstd]'"
        raise UsageError("zstandard", message=message) from error
    return lambda: zstandard.ZstdDecompressor(max_window_size=1 << _WINDOW).decompressobj()
