"""Read the packets of a pcapng file, from cobotwire or from another program."""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator, Sequence
from types import TracebackType
from typing import Self

from cobotwire.capture.block_file import BlockFile
from cobotwire.capture.block_parsing import Readable, Truncated, blocks_of, is_capture
from cobotwire.capture.capture_file import open_capture
from cobotwire.capture.foreign.recognising import Recognised
from cobotwire.capture.packet import Interface, Packet
from cobotwire.capture.packet_parsing import OURS, UNDATED, UNTIMED, PacketParser
from cobotwire.protocol.printable import printable

__all__ = ["CaptureReader", "is_capture", "read"]


def read(
    path: str | os.PathLike[str], *, format: str | None = None, ports: Sequence[int] = ()
) -> CaptureReader:
    """Open a capture; iterate over the result to get its packets.

    Files that are compressed with gzip or zstd are decompressed. Files that other programs wrote
    are read too, if they state times or directions; ``docs/guide/decode.md`` lists them.

    Args:
        path: the file.
        format: the format of a file of another program, such as ``socat``; None to detect it.
        ports: the TCP ports of arms in a capture of a network; empty for 9000 and 4500.

    Raises:
        UsageError: the file does not exist, or it cannot be read, or zstd is not installed.
        CaptureError: the file is not a capture, or it is damaged at ``offset`` (raised while
            iterating).
    """
    return CaptureReader(open_capture(path, format, ports), str(path))


class CaptureReader:
    """Yields the packets of a capture, in the order of the file (see ``docs/captures.md``).

    Attributes:
        name: the name of the file, for messages.
        truncated_at: the offset of the incomplete block at the end of the file; None if the last
            block is complete, or the end has not been read yet.
        packets: how many packets were read.
    """

    def __init__(self, file: Readable, name: str = "capture") -> None:
        """Read from an open binary file; ``name`` is for messages."""
        self.truncated_at: int | None = None
        self.name = name
        self.packets = 0
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
    def timed(self) -> bool:
        """Whether the packets have times. If they have none, all times are 0."""
        return not self.application.endswith(UNTIMED)

    @property
    def dated(self) -> bool:
        """Whether the times are those of a clock, and not counted from some start."""
        return not self.application.endswith((UNTIMED, UNDATED))

    @property
    def foreign(self) -> Recognised | None:
        """How a file of another program is read; None for a recording."""
        return self._origin if self._origin and self._origin.reader else None

    @property
    def incomplete(self) -> str:
        """What is missing at the end, in a sentence; empty if nothing is missing."""
        name = printable(self.name)
        if self.truncated_at is not None:
            return (
                f"{name} ends in the middle of a packet; "
                f"everything before byte {self.truncated_at} is complete"
            )
        if self._origin and self._origin.file.missing:
            return "; ".join(f"{name} {text}" for text in self._origin.file.missing)
        # Other programs need not mark a recording as finished.
        done = self.finished or not self.application.startswith(OURS)
        return "" if done else f"the recording {name} was not finished"

    @property
    def _origin(self) -> Recognised | None:
        """What the blocks were read from, if this is known."""
        origin = self._file.origin if isinstance(self._file, BlockFile) else None
        return origin if isinstance(origin, Recognised) else None

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
                    self.packets += 1
                    yield packet
        except Truncated as end:
            self.truncated_at = end.offset
        finally:
            self._file.close()
