"""Read captures into columns: the messages of each direction with their times.

::

    columns = read_columns("arm.pcapng", codec)
    angles = columns.rows("get_angles")
    angles.time, angles["angles"]
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from typing import Literal, Protocol

from cobotwire import codec as codecs
from cobotwire.capture.block_file import BlockFile
from cobotwire.capture.capture_file import open_capture
from cobotwire.capture.captured_columns import CapturedColumns
from cobotwire.capture.foreign.recognising import Recognised
from cobotwire.capture.packet import Interface
from cobotwire.capture.reference_columns import ReferenceCaptureReader
from cobotwire.codec.interface import Codec, Data, Listening
from cobotwire.protocol.errors import CaptureError

# A file, or its contents.
Source = str | os.PathLike[str] | Data
# One codec for all interfaces, or a function that returns the codec of an interface's edition.
Codecs = Codec | Callable[[Interface], Codec]

PIECE = 1 << 22


class ColumnsReader(Protocol):
    """Reads a capture piece by piece; the rows do not depend on the pieces.

    Memory is bounded whatever the file contains: between two calls the reader keeps an incomplete
    block (less than 16 MiB), and the bytes of each stream that are not yet part of a frame or of
    noise.
    """

    def feed(self, data: Data) -> CapturedColumns:
        """Take the next bytes of the file; return what became certain since the last call.

        Damage raises no exception: ``error`` of this batch and of all later ones states it, and
        later bytes are ignored.
        """
        ...

    def add(self, data: Data) -> None:
        """Take the next bytes of the file.

        The next call of another method returns what is certain.
        """
        ...

    def finish(self) -> CapturedColumns:
        """Take the end of the file: stop waiting for more bytes; return the rest."""
        ...


def capture_reader(
    codec: Codecs, listening: Listening = "both", *, raw: bool = False, name: str = "capture"
) -> ColumnsReader:
    """Return a reader for a capture that arrives in chunks.

    Args:
        codec: decodes the frames: one for all interfaces, or a function that is called with each
            interface that has packets, before the first of them is decoded.
        listening: the messages in packets of unknown direction; sent packets hold requests, and
            received ones replies.
        raw: whether columns hold raw values instead of physical ones.
        name: the name of the file, for messages.
    """
    if not callable(codec):
        reader = _reader_class(codec.name == "native" and codec.table.frame.reply_has_id)
        return reader(lambda _: codec, listening, raw, name)
    return _reader_class(codecs.chosen() == "native")(codec, listening, raw, name)


def _reader_class(native: bool) -> Callable[..., ColumnsReader]:
    if native:
        from cobotwire.capture.native_columns import NativeColumnsReader

        return NativeColumnsReader
    return ReferenceCaptureReader


def read_batches(
    source: Source,
    codec: Codecs,
    listening: Listening = "both",
    *,
    raw: bool = False,
    piece: int = PIECE,
) -> Iterator[CapturedColumns]:
    """Yield the columns of a capture in batches of ``piece`` bytes of the file, in bounded memory.

    The last batch has the rest, ``finished`` and ``truncated_at``.

    Args:
        source: the path of a file, which may be compressed with gzip or zstd; or the contents of
            a file: bytes, a bytearray, a memoryview or an mmap.
        codec: see :func:`capture_reader`.
        listening: see :func:`capture_reader`.
        raw: whether columns hold raw values instead of physical ones.
        piece: how many bytes of the file to read for each batch.

    Raises:
        UsageError: the file does not exist, or it cannot be read.
        CaptureError: the file is not a capture, or it is damaged at ``offset``. It is raised after
            the batches with everything before that place.
    """
    pieces = Pieces(source, piece)
    reader = capture_reader(codec, listening, raw=raw, name=pieces.name)
    for data in pieces:
        batch = reader.feed(data)
        yield batch
        if batch.error:
            break
    batch = pieces.checked(reader.finish())
    yield batch
    if batch.error:
        raise batch.error


def read_columns(
    source: Source,
    codec: Codecs,
    listening: Listening = "both",
    *,
    raw: bool = False,
    damaged: Literal["raise", "keep"] = "raise",
) -> CapturedColumns:
    """Return the messages of a whole capture as columns, with times and directions.

    Args:
        source: the path of a file, which may be compressed with gzip or zstd; or the contents of
            a file: bytes, a bytearray, a memoryview or an mmap.
        codec: see :func:`capture_reader`.
        listening: see :func:`capture_reader`.
        raw: whether columns hold raw values instead of physical ones.
        damaged: what to do with a damaged file: ``raise`` an error, or ``keep`` everything before
            the damage and return it with ``error``.

    Raises:
        UsageError: the file does not exist, or it cannot be read.
        CaptureError: the file is not a capture, or it is damaged at ``offset``.
    """
    pieces = Pieces(source, PIECE)
    reader = capture_reader(codec, listening, raw=raw, name=pieces.name)
    for data in pieces:
        reader.add(data)
    found = pieces.checked(reader.finish())
    if found.error and damaged == "raise":
        raise found.error
    return found


class Pieces:
    """The contents of a source, piece by piece.

    Attributes:
        name: the name of the file, for messages.
        error: why the file cannot be decompressed to its end; None if nothing is wrong so far.
        origin: how a compressed file or a file of another program was read; None for other sources.
    """

    def __init__(self, source: Source, size: int) -> None:
        self._source, self._size = source, size
        is_path = isinstance(source, str | os.PathLike)
        self.name = str(source) if is_path else "capture"
        self.error: CaptureError | None = None
        self.origin: Recognised | None = None
        self._read_bytes = 0

    @property
    def size(self) -> int:
        """The bytes of the file that were read so far, after decompression."""
        foreign = self.origin and self.origin.reader
        return self.origin.file.size if self.origin and foreign else self._read_bytes

    def __iter__(self) -> Iterator[Data]:
        if isinstance(self._source, str | os.PathLike):
            yield from self._read(self._source)
            return
        view = memoryview(self._source).cast("B")
        for start in range(0, len(view), self._size):
            yield view[start : start + self._size]

    def _read(self, path: str | os.PathLike[str]) -> Iterator[bytes]:
        with closing(open_capture(path)) as file:
            if isinstance(file, BlockFile) and isinstance(file.origin, Recognised):
                self.origin = file.origin
            data = [b""]
            while data:
                data = []
                missing = self._size
                try:
                    while missing and (more := file.read(missing)):
                        data.append(more)
                        missing -= len(more)
                except CaptureError as error:
                    self.error = error
                if data:
                    joined = b"".join(data)
                    self._read_bytes += len(joined)
                    yield joined
                if self.error:
                    return

    def checked(self, last: CapturedColumns) -> CapturedColumns:
        """Return the last columns with the error of this file, if it has one."""
        return replace(last, error=self.error) if self.error and not last.error else last
