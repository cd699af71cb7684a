"""Open a capture, compressed or not."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Protocol

from cobotwire.capture.compression import (
    Compression,
    DamagedCompression,
    Decompressed,
    compression_of,
)
from cobotwire.capture.file_errors import unusable_file
from cobotwire.protocol.errors import CaptureError

# Bytes to read at a time from a compressed file.
BLOCK = 1 << 16
MAGIC = 4


class Readable(Protocol):
    """A file that is read from its beginning to its end."""

    def read(self, size: int, /) -> bytes:
        """Return some bytes, at most ``size``; none at the end."""
        ...

    def close(self) -> None:
        """Close the file."""
        ...


def open_capture(path: str | os.PathLike[str]) -> Readable:
    """Open a capture for reading; gzip and zstd are decompressed, whatever the name of the file.

    Raises:
        UsageError: the file does not exist, or it cannot be read, or zstd is not installed.
        CaptureError: while reading: the compressed data is damaged.
    """
    try:
        file = Path(path).open("rb")  # noqa: SIM115  (closed by the caller)
    except (OSError, ValueError) as error:
        raise unusable_file("capture", path, error) from None
    try:
        # A pipe is not read before the packets are.
        first = file.peek(MAGIC)[:MAGIC] if file.seekable() else b""
        compression = compression_of(first)
        return CompressedFile(file, compression, str(path)) if compression else file
    except BaseException:
        file.close()
        raise


class CompressedFile:
    """Reads the decompressed bytes of an open file."""

    def __init__(self, file: BinaryIO, compression: Compression, name: str) -> None:
        self._file, self._name = file, name
        stored: Iterator[bytes] = iter(lambda: file.read(BLOCK), b"")
        self._pieces = Decompressed(stored, compression, name)
        self._piece = memoryview(b"")
        self._offset = 0

    def read(self, size: int, /) -> bytes:
        """Return some bytes, at most ``size``; none at the end.

        Raises:
            CaptureError: the compressed data is damaged; the offset is that of decompressed bytes.
        """
        if not self._piece:
            try:
                self._piece = memoryview(next(self._pieces, b""))
            except DamagedCompression as error:
                why = f"the compressed data is damaged: {error}"
                raise CaptureError(self._name, self._offset, why) from error
        data = self._piece[:size].tobytes()
        self._piece = self._piece[size:]
        self._offset += len(data)
        return data

    def close(self) -> None:
        """Close the file."""
        self._file.close()
