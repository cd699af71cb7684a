"""Read captures into columns: the messages of each direction with their times.

::

    columns = read_columns("arm.pcapng", codec)
    angles = columns.rows("get_angles")
    angles.time, angles["angles"]
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO, Literal, Protocol

from cobotwire import codec as codecs
from cobotwire.capture.captured_columns import CapturedColumns
from cobotwire.capture.file_errors import unusable_file
from cobotwire.capture.packet import Interface
from cobotwire.capture.reference_columns import ReferenceCaptureReader
from cobotwire.codec.interface import Codec, Data, Listening

# A file, or its contents.
Source = str | os.PathLike[str] | Data
# One codec for all interfaces, or a function that returns that of an interface's edition.
Codecs = Codec | Callable[[Interface], Codec]

PIECE = 1 << 22


class ColumnsReader(Protocol):
    """Reads a capture piece by piece; the rows do not depend on the pieces.

    Memory is bounded whatever the file contains: between two calls the reader keeps an incomplete
    block (less than 16 MiB), and the bytes of each stream that are not accounted for yet.
    """

    def feed(self, data: Data) -> CapturedColumns:
        """Take the next bytes of the file; return what became certain since the last call.

        Damage is not raised: the ``error`` of this batch and all later ones tells it, and later
        bytes are ignored.
        """
        ...

    def add(self, data: Data) -> None:
        """Take the next bytes of the file; the next call of the others returns what is certain."""
        ...

    def finish(self) -> CapturedColumns:
        """Take the end of the file: stop waiting for more bytes; return the rest."""
        ...


def capture_reader(
    codec: Codecs, listening: Listening = "both", *, raw: bool = False, name: str = "capture"
) -> ColumnsReader:
    """Return a reader for a capture that comes in pieces.

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
    """Yield a capture in batches, in bounded memory: the columns of ``piece`` bytes of it each.

    The last batch has the rest, ``finished`` and ``truncated_at``.

    Args:
        source: the path of a file, or its contents: bytes, a bytearray, a memoryview or an mmap.
        codec: see :func:`capture_reader`.
        listening: see :func:`capture_reader`.
        raw: whether columns hold raw values instead of physical ones.
        piece: how many bytes of the file to read for each batch.

    Raises:
        UsageError: the file does not exist, or it cannot be read.
        CaptureError: the file is not a capture, or it is damaged at ``offset``. It is raised after
            the batches with everything before that place.
    """
    name = str(source) if isinstance(source, str | os.PathLike) else "capture"
    reader = capture_reader(codec, listening, raw=raw, name=name)
    for data in _pieces(source, piece):
        batch = reader.feed(data)
        yield batch
        if batch.error:
            break
    batch = reader.finish()
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
        source: the path of a file, or its contents: bytes, a bytearray, a memoryview or an mmap.
        codec: see :func:`capture_reader`.
        listening: see :func:`capture_reader`.
        raw: whether columns hold raw values instead of physical ones.
        damaged: what to do with a damaged file: ``raise`` an error, or ``keep`` everything before
            the damage and return it with ``error``.

    Raises:
        UsageError: the file does not exist, or it cannot be read.
        CaptureError: the file is not a capture, or it is damaged at ``offset``.
    """
    name = str(source) if isinstance(source, str | os.PathLike) else "capture"
    reader = capture_reader(codec, listening, raw=raw, name=name)
    for data in _pieces(source, PIECE):
        reader.add(data)
    found = reader.finish()
    if found.error and damaged == "raise":
        raise found.error
    return found


def _pieces(source: Source, size: int) -> Iterator[Data]:
    if not isinstance(source, str | os.PathLike):
        view = memoryview(source).cast("B")
        for start in range(0, len(view), size):
            yield view[start : start + size]
        return
    with _opened(source) as file:
        while data := file.read(size):
            yield data


def _opened(path: str | os.PathLike[str]) -> BinaryIO:
    try:
        return Path(path).open("rb")
    except (OSError, ValueError) as error:
        raise unusable_file("capture", path, error) from None
