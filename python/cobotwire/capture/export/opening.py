"""Open an input, decompress it, and count the stored bytes that are read."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import BinaryIO

from cobotwire.capture.compression import (
    Compression,
    DamagedCompression,
    Decompressed,
    compression_of,
)
from cobotwire.capture.export.inputs import COMPRESSED, STDIN, Input, is_url, store_of
from cobotwire.capture.file_errors import unusable_file
from cobotwire.capture.foreign.recognising import recognise
from cobotwire.protocol.errors import LinkError, UnreadableInput

Progress = Callable[[int], None]
# Stored bytes to read at a time.
BLOCK = 1 << 18


class InputStream:
    """Reads the decompressed bytes of an input.

    Attributes:
        name: the name of the input, for messages.
        truncated: why the input cannot be read on; empty if it could be read so far.
        found: its format.
    """

    def __init__(
        self, input: Input, progress: Progress, format: str | None = None, ports: Sequence[int] = ()
    ) -> None:
        """Open an input, and recognise its format.

        Args:
            input: the input.
            progress: gets the number of stored bytes of each read.
            format: see :func:`~cobotwire.capture.foreign.recognising.recognise`.
            ports: the TCP ports of arms; see ``recognise`` too.

        Raises:
            UsageError: it cannot be opened, or a package is missing.
            UnreadableInput: it is empty, or its format is not known.
            LinkError: reading failed.
        """
        self.name = input.url
        self.truncated = ""
        self._progress = progress
        self._file = _open(input)
        self._rest = b""
        try:
            missing: list[str] = []
            blocks = self._decompressed(input, missing)
            self.found = recognise(blocks, self.name, format, ports, missing)
        except BaseException:
            self.close()
            raise

    def read(self, size: int) -> bytes:
        """Return ``size`` bytes, fewer only at the end.

        Raises:
            LinkError: reading failed, or the compressed data is damaged.
        """
        pieces = [self._rest]
        missing = size - len(self._rest)
        try:
            while missing > 0 and (block := next(self.found.blocks, b"")):
                pieces.append(block)
                missing -= len(block)
        except UnreadableInput as error:
            # A generator that raised an error yields nothing more.
            line = f"line {error.line}: " * bool(error.line)
            self.truncated = f"{line}{error.detail}; everything before that is exported"
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

    def _decompressed(self, input: Input, missing: list[str]) -> Iterator[bytes]:
        """Yield the bytes of the capture, in blocks that are not empty."""
        stored = self._stored()
        first = next(stored, b"")
        compression = _compression(input, first)
        blocks = chain([first] if first else [], stored)
        if compression is None:
            yield from blocks
            return
        try:
            yield from Decompressed(blocks, compression, input.url, missing)
        except DamagedCompression as error:
            raise LinkError(self.name, f"decompressing failed: {error}") from error


def _open(input: Input) -> BinaryIO:
    try:
        if input.url == STDIN:
            return open(0, "rb", buffering=0, closefd=False)
        if is_url(input.url):
            store, path = store_of(input.url)
            opened: BinaryIO = store.open(path, "rb")
            return opened
        return open(input.url, "rb", buffering=0)
    except (OSError, ValueError) as error:
        raise unusable_file("INPUT", input.url, error) from None


def _compression(input: Input, first: bytes) -> Compression | None:
    """Return how an input is compressed. Standard input has no extension that says so."""
    if input.url == STDIN:
        return compression_of(first)
    kinds = (kind for end, kind in COMPRESSED.items() if input.url.endswith(end))
    return next(kinds, None)
