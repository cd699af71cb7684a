"""Open a capture, compressed or not."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO

from cobotwire.capture.block_file import BlockFile
from cobotwire.capture.block_parsing import Readable
from cobotwire.capture.compression import Compression, compression_of, decompressed
from cobotwire.capture.file_errors import unusable_file
from cobotwire.capture.foreign.recognising import Recognised, recognise
from cobotwire.protocol.errors import CaptureError, UnreadableInput

# Bytes to read at a time from a compressed file.
BLOCK = 1 << 16
MAGIC = 4


def open_capture(
    path: str | os.PathLike[str], format: str | None = None, ports: Sequence[int] = ()
) -> Readable:
    """Open a capture for reading; gzip and zstd are decompressed, whatever the name of the file.

    Files of other programs that state times or directions become recordings; ``format`` and
    ``ports`` are as in :func:`~cobotwire.capture.foreign.recognising.recognise`.

    Raises:
        UsageError: the file does not exist, or it cannot be read, or zstd is not installed.
        CaptureError: while reading: the compressed data is damaged.
    """
    try:
        file = Path(path).open("rb")  # noqa: SIM115  (closed by the caller)
    except (OSError, ValueError) as error:
        raise unusable_file("capture", path, error) from None
    name = str(path)
    try:
        # A pipe cannot go back to its start, so its format is not detected.
        if not file.seekable():
            return file
        compression = compression_of(file.peek(MAGIC)[:MAGIC])
        missing: list[str] = []
        blocks = _blocks(file, compression, name, missing)
        found = _recognised(blocks, name, format, ports, missing)
        if found and found.recording and (found.reader or compression):
            return BlockFile(found.blocks, file, found)
        file.seek(0)
        return BlockFile(_blocks(file, compression, name, []), file) if compression else file
    except BaseException:
        file.close()
        raise


def _blocks(
    file: BinaryIO, compression: Compression | None, name: str, missing: list[str]
) -> Iterator[bytes]:
    stored = iter(lambda: file.read(BLOCK), b"")
    return decompressed(stored, compression, name, missing) if compression else stored


def _recognised(
    blocks: Iterator[bytes],
    name: str,
    format: str | None,
    ports: Sequence[int],
    missing: list[str],
) -> Recognised | None:
    """Return the contents of a file; None if the reader of recordings is to report the error."""
    try:
        return recognise(blocks, name, format, ports, missing)
    except (UnreadableInput, CaptureError):
        if format is not None:
            raise
        return None
