"""Open an input, decompress it, and count the stored bytes that are read."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any, BinaryIO

import pyarrow as pa

from cobotwire.capture.export.extras import needed
from cobotwire.capture.export.inputs import COMPRESSED, STDIN, Input, is_url
from cobotwire.capture.file_errors import unusable_file
from cobotwire.protocol.errors import LinkError

Progress = Callable[[int], None]
# What standard input begins with if it is compressed: it has no name with an ending.
_MAGIC = {b"\x1f\x8b\x08": "gzip", b"\x28\xb5\x2f\xfd": "zstd"}


class InputStream:
    """Reads the decompressed bytes of an input.

    Attributes:
        name: the name of the input, for messages.
        truncated: why the input ends too early; empty if it does not.
    """

    def __init__(self, input: Input, progress: Progress) -> None:
        """Open an input; ``progress`` gets the number of stored bytes of each read.

        Raises:
            UsageError: it cannot be opened, or a package is missing.
        """
        self.name = input.url
        self.truncated = ""
        self._stored = _Stored(_open(input), progress)
        self._reader: Any = self._stored
        if compression := _compression(input, self._stored):
            self._reader = pa.CompressedInputStream(self._stored, compression)

    def read(self, size: int) -> bytes:
        """Return up to ``size`` bytes, fewer only at the end.

        Raises:
            LinkError: reading failed, or the compressed data is damaged.
        """
        pieces = []
        while size > 0 and not self.truncated:
            piece = self._read(size)
            if not piece:
                break
            pieces.append(piece)
            size -= len(piece)
        return pieces[0] if len(pieces) == 1 else b"".join(pieces)

    def _read(self, size: int) -> bytes:
        try:
            return bytes(self._reader.read(size))
        except OSError as error:
            # The error of pyarrow has no number. All bytes before the end have been returned.
            if error.errno is None and "Truncated compressed stream" in str(error):
                self.truncated = "its compressed data is cut off"
                return b""
            raise LinkError(self.name, f"reading failed: {error.strerror or error}") from error

    def close(self) -> None:
        """Close the input."""
        self._stored.close()


class _Stored(io.RawIOBase):
    """Reads stored bytes, and reports how many; ``peek`` looks at the first of them."""

    def __init__(self, file: BinaryIO, progress: Progress) -> None:
        super().__init__()
        self._file, self._progress = file, progress
        self._start = b""

    def readable(self) -> bool:
        return True

    def peek(self, size: int) -> bytes:
        while len(self._start) < size and (block := self._file.read(size - len(self._start))):
            self._start += block
        return self._start

    def read(self, size: int = -1, /) -> bytes:
        start, self._start = self._start, b""
        data = start or self._file.read(size) or b""
        self._progress(len(data))
        return data

    def close(self) -> None:
        self._file.close()
        super().close()


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


def _compression(input: Input, stored: _Stored) -> str | None:
    if input.url != STDIN:
        return next((kind for end, kind in COMPRESSED.items() if input.url.endswith(end)), None)
    start = stored.peek(4)
    return next((kind for magic, kind in _MAGIC.items() if start.startswith(magic)), None)
