"""Open what to decode: hex arguments, a file or standard input; detect what they hold."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import IO, TYPE_CHECKING, NamedTuple

from cobotwire.capture.file_errors import unusable_file
from cobotwire.capture.foreign.hex_text import hex_arguments
from cobotwire.protocol.errors import LinkError, UsageError

if TYPE_CHECKING:
    from cobotwire.capture.foreign.recognising import Recognised
    from cobotwire.capture.reader import CaptureReader

__all__ = ["ByteSource", "hex_arguments", "open_input"]

# Bytes to read at a time. A pipe returns what it has.
BLOCK = 1 << 18


class ByteSource(NamedTuple):
    """Blocks of bytes, each with the number of input bytes that were read for it.

    ``size`` is the length of the input in bytes, if it is known. ``from_arguments`` is whether the
    arguments themselves are the bytes. ``missing`` lists what the input lacks; the list is complete
    when all blocks were read.
    """

    blocks: Iterator[tuple[bytes, int]]
    size: int | None
    from_arguments: bool
    missing: Sequence[str] = ()


def open_input(
    arguments: Sequence[str],
    format: str | None,
    notify: Callable[[str], None],
    ports: Sequence[int] = (),
) -> ByteSource | CaptureReader:
    """Open what the arguments name: bytes in hex, a file, or ``-`` for standard input.

    If ``format`` is None, it is detected. If another program wrote the input, ``notify`` is then
    called with a sentence about it. Recordings, and files of other programs that state times or
    directions, are returned as recordings.

    Raises:
        UsageError: the arguments name no bytes, or they are ambiguous, or the file cannot be read.
        LinkError: also while reading: the input cannot be read to its end.
    """
    name = arguments[0]
    if format is None and name != "-":
        data = hex_arguments(arguments)
        if data is not None:
            if len(arguments) == 1 and os.path.exists(name):
                message = (
                    f"{name} is both a file and hex: "
                    f"use ./{name} for the file, 0x{name} for the bytes"
                )
                raise UsageError("FILE", name, message=message)
            return ByteSource(iter([(data, len(data))]), len(data), from_arguments=True)
    if len(arguments) > 1:
        text = " ".join(arguments)
        message = f"{text} is not hex; give pairs of hex digits, one FILE, or -"
        raise UsageError("HEX", text, message=message)
    return _read(_open(name), name, format, notify, ports)


def _open(name: str) -> IO[bytes]:
    try:
        if name == "-":
            return open(0, "rb", buffering=0, closefd=False)
        return open(name, "rb", buffering=0)
    except (OSError, ValueError) as error:
        raise unusable_file("FILE", name, error) from None


class _Stored(Iterator[bytes]):
    """Yields the blocks of a stream, and closes it; ``take`` counts their bytes."""

    def __init__(self, stream: IO[bytes], name: str) -> None:
        self._stream, self._name, self._size = stream, name, 0

    def __next__(self) -> bytes:
        try:
            block = self._stream.read(BLOCK)
        except OSError as error:
            raise LinkError(self._name, f"reading failed: {error.strerror}") from error
        if not block:
            raise StopIteration
        self._size += len(block)
        return block

    def take(self) -> int:
        """Return how many bytes were read since the last call."""
        size, self._size = self._size, 0
        return size

    def close(self) -> None:
        """Close the stream."""
        self._stream.close()


def _read(
    stream: IO[bytes],
    name: str,
    format: str | None,
    notify: Callable[[str], None],
    ports: Sequence[int],
) -> ByteSource | CaptureReader:
    # Imported here, because hex arguments do not need it.
    from cobotwire.capture.block_file import BlockFile
    from cobotwire.capture.foreign.recognising import recognise
    from cobotwire.capture.reader import CaptureReader, read

    status = os.fstat(stream.fileno())
    size = status.st_size if stat.S_ISREG(status.st_mode) else None
    stored = _Stored(stream, name)
    try:
        missing: list[str] = []
        blocks = _decompressed(stored, name, format, missing)
        found = recognise(blocks, name, format, ports, missing)
    except BaseException:
        stored.close()
        raise
    if found.notice and format is None:
        notify(found.notice)
    if found.recording and found.reader is None and size is not None:
        # A recording that is a plain file is read faster directly than in blocks.
        stored.close()
        return read(name)
    if found.recording:
        return CaptureReader(BlockFile(found.blocks, stored, found), name)
    return ByteSource(_counted(found, stored, notify), size, False, found.file.missing)


def _decompressed(
    stored: Iterator[bytes], name: str, format: str | None, missing: list[str]
) -> Iterator[bytes]:
    """Yield the contents of a file that may be compressed."""
    from cobotwire.capture.compression import compression_of, decompressed

    first = next(stored, b"")
    compression = None if format == "raw" else compression_of(first)
    blocks = chain([first], stored)
    return decompressed(blocks, compression, name, missing) if compression else blocks


def _counted(
    found: Recognised, stored: _Stored, notify: Callable[[str], None]
) -> Iterator[tuple[bytes, int]]:
    try:
        for block in found.blocks:
            yield block, stored.take()
        for text in found.file.remarks():
            notify(text)
    finally:
        stored.close()
