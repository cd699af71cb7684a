"""Read the packets of a pcapng file, ours or another program's."""

from __future__ import annotations

import os
import struct
from collections.abc import Generator, Iterator
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Literal, NamedTuple, NoReturn, Self

from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.block_parsing import Block, Fields, Truncated, blocks_of
from cobotwire.capture.file_errors import unusable_file
from cobotwire.capture.packet import Direction, Interface, Packet, with_comment
from cobotwire.protocol.errors import CaptureError
from cobotwire.protocol.printable import printable

DIRECTIONS: tuple[Direction, ...] = ("unknown", "received", "sent", "unknown")
MICROSECONDS = 6
# Files of other applications hold raw chunks; ours hold frames and noise.
OURS = "cobotwire"


def is_capture(first_bytes: bytes) -> bool:
    """Return whether a file that begins with these bytes (12 suffice) is a pcapng file."""
    magic = struct.pack("<I", blocks.BYTE_ORDER_MAGIC)
    kind = struct.pack("<I", blocks.SECTION)
    return first_bytes[:4] == kind and first_bytes[8:12] in (magic, magic[::-1])


def read(path: str | os.PathLike[str]) -> CaptureReader:
    """Open a capture; iterate over the result to get its packets.

    Raises:
        UsageError: the file does not exist, or it cannot be read.
        CaptureError: while iterating: the file is not a capture, or it is damaged at ``offset``.
    """
    try:
        file = Path(path).open("rb")  # noqa: SIM115  (closed by the reader)
    except (OSError, ValueError) as error:
        raise unusable_file("capture", path, error) from None
    return CaptureReader(file, str(path))


class _Format(NamedTuple):
    """How to read the packets of one interface."""

    number: int
    link_type: int
    resolution: int
    offset_seconds: int

    def nanoseconds(self, high: int, low: int) -> int:
        """Return a time stamp in nanoseconds; finer fractions are cut off."""
        exponent = self.resolution & 0x7F
        units: int = 2**exponent if self.resolution & 0x80 else 10**exponent
        return (high << 32 | low) * 1_000_000_000 // units + self.offset_seconds * 1_000_000_000


class CaptureReader:
    """Yields the packets of a capture, in the order of the file (see ``docs/captures.md``).

    Attributes:
        name: the name of the file, for messages.
        interfaces: the interfaces that the blocks read so far describe.
        application: the name of the program that wrote the capture.
        truncated_at: the offset of the incomplete block at the end of the file; None if the last
            block is complete, or the end has not been read yet.
    """

    def __init__(self, file: BinaryIO, name: str = "capture") -> None:
        """Read from an open binary file; ``name`` is for messages."""
        self.interfaces: list[Interface] = []
        self.application = ""
        self.truncated_at: int | None = None
        self.name = name
        self._file = file
        self._formats: list[_Format] = []
        self._finished: set[int] = set()
        self._endian: Literal["little", "big"] = "little"
        self._packets = self._read()

    @property
    def finished(self) -> bool:
        """Whether the recorder was closed.

        A capture that is still being written, or that a killed program wrote, is not finished. In
        most cases it is not truncated either.
        """
        return len(self._finished) == len(self.interfaces) > 0

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
                fields = Fields(block, self.name)
                if block.kind == blocks.PACKET:
                    yield self._packet(block, fields)
                elif block.kind == blocks.SECTION:
                    self._section(block, fields)
                elif block.kind == blocks.INTERFACE:
                    self._interface(block, fields)
                elif block.kind == blocks.STATISTICS:
                    self._finished.add(self._format(block, fields).number)
                elif block.kind in (blocks.SIMPLE_PACKET, blocks.OBSOLETE_PACKET):
                    self._reject(block, "its packets have neither a time nor a direction")
                # Other blocks (names, secrets, private ones) are skipped.
        except Truncated as end:
            self.truncated_at = end.offset
        finally:
            self._file.close()

    def _section(self, block: Block, fields: Fields) -> None:
        _, major, _, _ = fields.numbers("IHHq")
        if major != blocks.VERSION[0]:
            self._reject(block, f"it has pcapng version {major}; supported: {blocks.VERSION[0]}")
        # Interface indexes start from 0 in each section.
        self._formats = []
        self._endian = "little" if block.order == "<" else "big"
        options = dict(fields.options())
        self.application = _text(options.get(blocks.SECTION_APPLICATION, b""))

    def _interface(self, block: Block, fields: Fields) -> None:
        link_type, _, _ = fields.numbers("HHI")
        options = dict(fields.options())
        for code in (blocks.INTERFACE_SPEED, blocks.INTERFACE_OFFSET):
            if len(options.get(code, b"")) > blocks.NUMBER_SIZE:
                self._reject(block, "damaged: a number of an interface is too long")
        description = _text(options.get(blocks.INTERFACE_DESCRIPTION, b""))
        key, _, edition = description.partition(" ")
        speed = int.from_bytes(options.get(blocks.INTERFACE_SPEED, b""), self._endian)
        name = _text(options.get(blocks.INTERFACE_NAME, b""))
        self.interfaces.append(Interface(name, edition if key == "edition" else "", speed))
        resolution = options.get(blocks.INTERFACE_RESOLUTION) or bytes([MICROSECONDS])
        offset = options.get(blocks.INTERFACE_OFFSET, b"")
        seconds = int.from_bytes(offset, self._endian, signed=True)
        self._formats.append(_Format(len(self.interfaces) - 1, link_type, resolution[0], seconds))

    def _packet(self, block: Block, fields: Fields) -> Packet:
        format = self._format(block, fields)
        if format.link_type not in blocks.USER_LINK_TYPES:
            self._reject(block, f"link type {format.link_type} is not that of a serial recording")
        high, low, size, _ = fields.numbers("IIII")
        data = fields.data(size)
        options = dict(fields.options())
        flags = int.from_bytes(options.get(blocks.PACKET_FLAGS, b""), self._endian)
        packet = Packet(
            format.nanoseconds(high, low),
            DIRECTIONS[flags & 3],
            data,
            "frame" if self.application.startswith(OURS) else "bytes",
            interface=format.number,
        )
        return with_comment(packet, _text(options.get(blocks.COMMENT, b"")))

    def _format(self, block: Block, fields: Fields) -> _Format:
        (index,) = fields.numbers("I")
        if index >= len(self._formats):
            self._reject(block, f"damaged: the file does not describe interface {index}")
        return self._formats[index]

    def _reject(self, block: Block, why: str) -> NoReturn:
        raise CaptureError(self.name, block.offset, why)


def _text(value: bytes) -> str:
    return value.rstrip(b"\0").decode("utf-8", "replace")
