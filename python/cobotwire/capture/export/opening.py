"""Open an input, decompress it, and count the stored bytes that are read."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator
from typing import Any, BinaryIO

from cobotwire.capture.export.extras import needed
from cobotwire.capture.export.inputs import COMPRESSED, STDIN, Input, is_url
from cobotwire.capture.file_errors import unusable_file
from cobotwire.protocol.errors import LinkError

Progress = Callable[[int], None]
# Stored bytes to read at a time.
BLOCK = 1 << 18
# Compressed bytes to decompress at a time: hostile data may become 30,000 times as large.
SLICE = 1 << 12
# What standard input begins with if it is compressed: it has no name with an ending.
_MAGIC = {b"\x1f\x8b\x08": "gzip", b"\x28\xb5\x2f\xfd": "zstd"}


class InputStream:
    """Reads the decompressed bytes of an input.

    Attributes:
        name: the name of the input, for messages.
        truncated: why the input ends too early; empty if it does not, or has not ended yet.
    """

    def __init__(self, input: Input, progress: Progress) -> None:
        """Open an input; ``progress`` gets the number of stored bytes of each read.

        Raises:
            UsageError: it cannot be opened, or a package is missing.
        """
        self.name = input.url
        self.truncated = ""
        self._progress = progress
        self._file = _open(input)
        self._blocks = self._decompressed(input)
        self._rest = b""

    def read(self, size: int) -> bytes:
        """Return ``size`` bytes, fewer only at the end.

        Raises:
            LinkError: reading failed, or the compressed data is damaged.
        """
        pieces = [self._rest]
        missing = size - len(self._rest)
        while missing > 0 and (block := next(self._blocks, b"")):
            pieces.append(block)
            missing -= len(block)
        joined = b"".join(pieces)
        self._rest = joined[size:]
        return joined[:size]

    def close(self) -> None:
        """Close the input."""
        self._file.close()

    def _stored(self) -> Iterator[bytes]:
        """Yield the stored bytes."""
        try:
            while block := self._file.read(BLOCK):
                self._progress(len(block))
                yield block
        except OSError as error:
            raise LinkError(self.name, f"reading failed: {error.strerror or error}") from error

    def _decompressed(self, input: Input) -> Iterator[bytes]:
        """Yield the bytes of the capture, in blocks that are not empty."""
        stored = self._stored()
        first = next(stored, b"")
        start = _decompressor(input, first)
        if start is None:
            if first:
                yield first
            yield from stored
            return
        current = start()
        while first:
            for at in range(0, len(first), SLICE):
                rest = first[at : at + SLICE]
                while rest:
                    # Programs that append write one compressed part after another.
                    current = start() if current.eof else current
                    if data := self._expand(current, rest):
                        yield data
                    rest = current.unused_data
            first = next(stored, b"")
        if not current.eof:
            self.truncated = "its compressed data is cut off"

    def _expand(self, decompressor: Any, data: bytes) -> bytes:
        try:
            return bytes(decompressor.decompress(data))
        # Each library has errors of its own.
        except Exception as error:
            raise LinkError(self.name, f"decompressing failed: {error}") from error


def _open(input: Input) -> BinaryIO:
    try:
        if input.url == STDIN:
            return open(0, "rb", buffering=0, closefd=False)
        if is_url(input.url):
            fsspec = needed("fsspec", "fsspec", f"reading {input.url}")
            opened: BinaryIO = fsspec.open(input.url, "rb").open()
            return opened
        return open(input.url, "rb", buffering=0)
    except (OSError, ValueError) as error:
        raise unusable_file("INPUT", input.url, error) from None


def _decompressor(input: Input, first: bytes) -> Callable[[], Any] | None:
    """Return what makes a decompressor for one part of an input; None if it is not compressed."""
    if input.url == STDIN:
        kinds = (kind for magic, kind in _MAGIC.items() if first.startswith(magic))
    else:
        kinds = (kind for end, kind in COMPRESSED.items() if input.url.endswith(end))
    kind = next(kinds, None)
    if kind == "gzip":
        return lambda: zlib.decompressobj(wbits=31)
    if kind == "zstd":
        zstandard = needed("zstandard", "zstd", f"reading {input.url}")
        return lambda: zstandard.ZstdDecompressor().decompressobj()
    return None
