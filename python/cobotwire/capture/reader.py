"""Read the packets of a pcapng file, from cobotwire or from another program."""

from __future__ import annotations

import os
import struct
from collections.abc import Generator, Iterator
from types import TracebackType
from typing import Self

from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.block_parsing import Truncated, blocks_of
from cobotwire.capture.capture_file import Readable, open_capture
from cobotwire.capture.packet import Interface, Packet
from cobotwire.capture.packet_parsing import PacketParser
from cobotwire.protocol.printable import printable


def is_capture(first_bytes: bytes) -> bool:
    """Return whether a file that begins with these bytes (12 suffice) is a pcapng file."""
    magic = struct.pack("<I", blocks.BYTE_ORDER_MAGIC)
    kind = struct.pack("<I", blocks.SECTION)
    return first_bytes[:4] == kind and first_bytes[8:12] in (magic, magic[::-1])


def read(path: str | os.PathLike[str]) -> CaptureReader:
    """Open a capture; iterate over the result to get its packets.

    Files that are compressed with gzip or zstd are decompressed.

    Raises:
        UsageError: the file does not exist, or it cannot be read, or zstd is not installed.
        CaptureError: the file is not a capture, or it is damaged at ``offset`` (raised while
            iterating).
    """
    return CaptureReader(open_capture(path), str(path))


class CaptureReader:
    """Yields the packets of a capture, in the order of the file (see ``docs/captures.md``).

    Attributes:
        name: the name of the file, for messages.
        truncated_at: the offset of the incomplete block at the end of the file; None if the last
            block is complete, or the end has not been read yet.
    """

    def __init__(self, file: Readable, name: str = "capture") -> None:
        """Read from an open binary file; ``name`` is for messages."""
        self.truncated_at: int | None = None
        self.name = name
        self._file = file
        self._parser = PacketParser(name)
        self._packets = self._read()

    @property
    def interfaces(self) -> list[Interface]:
        """The interfaces that the blocks read so far describe."""
        return self._parser.interfaces

    @property
    def application(self) -> str:
        """The name of the program that wrote the capture."""
        return self._parser.application

    @property
    def finished(self) -> bool:
        """Whether the recorder was closed.

        A capture that is still being written, or that a killed program wrote, is not finished. In
        most cases it is not truncated either.
        """
        return self._parser.finished

    @property
    def incomplete(self) -> str:
        """What is missing at the end, in a sentence; empty if nothing is missing."""
        name = printable(self.name)
        if self.truncated_at is not None:
            return (
                f"{name} ends in the middle of a packet; "
                f"everything before byte {self.truncated_at} is complete"
            )
        return "" if self.finished else f"the recording {name} was not finished"

    def __iter__(self) -> Iterator[Packet]:
        return self

    def __next__(self) -> Packet:
        return next(self._packets)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file. Reading the last packet also closes it."""
        self._packets.close()
        self._file.close()

    def _read(self) -> Generator[Packet, None, None]:
        try:
            for block in blocks_of(self._file, self.name):
                packet = self._parser.take(block)
                if packet is not None:
                    yield packet
        except Truncated as end:
            self.truncated_at = end.offset
        finally:
            self._file.close()
