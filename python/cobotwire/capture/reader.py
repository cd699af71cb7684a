"""A pcapng file to packets, ours or another program's."""

from __future__ import annotations

import os
import struct
from collections.abc import Generator, Iterator
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Literal, NamedTuple, NoReturn, Self

from cobotwire.capture import blocks
from cobotwire.capture.packet import Direction, Interface, Packet, with_comment
from cobotwire.capture.parse import Block, Fields, Truncated, blocks_of
from cobotwire.errors import CaptureError, UsageError

DIRECTIONS: tuple[Direction, ...] = ("unknown", "heard", "sent", "unknown")
MICROSECONDS = 6
# What cuts packets at frames, and says what they are.
OURS = "cobotwire"


def is_capture(first_bytes: bytes) -> bool:
    """Whether a file that begins like this (12 bytes are enough) is a pcapng file."""
    magic = struct.pack("<I", blocks.BYTE_ORDER_MAGIC)
    kind = struct.pack("<I", blocks.SECTION)
    return first_bytes[:4] == kind and first_bytes[8:12] in (magic, magic[::-1])


def read(path: str | os.PathLike[str]) -> CaptureReader:
    """Open a capture; iterating over what this gives gives its packets.

    Raises:
        UsageError: there is no such file, or it cannot be read.
        CaptureError: while iterating: it is no capture, or damaged; its ``offset`` says where.
    """
    try:
        file = Path(path).open("rb")  # noqa: SIM115  (closed by the reader)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UsageError("capture", str(path), f"a file that can be read ({reason})") from None
    return CaptureReader(file, str(path))


class _Line(NamedTuple):
    """How the numbers of one interface's packets are to be read."""

    number: int
    link_type: int
    resolution: int
    offset_seconds: int

    def nanoseconds(self, high: int, low: int) -> int:
        """A time stamp; what is finer than nanoseconds is cut."""
        exponent = self.resolution & 0x7F
        units: int = 2**exponent if self.resolution & 0x80 else 10**exponent
        return (high << 32 | low) * 1_000_000_000 // units + self.offset_seconds * 1_000_000_000


class CaptureReader:
    """The packets of a capture, in the order of the file; see ``docs/captures.md`` for that order.

    Attributes:
        name: the file's, for messages.
        interfaces: the lines that the blocks read so far introduce.
        application: what wrote the capture, in its own words.
        truncated_at: where the block begins in whose middle the file ends; None if it ends between
            blocks, or that is not known yet.
        finished: whether the recording was ended in order. A capture that is still being written,
            or whose writer was killed, is neither finished nor, mostly, truncated.
    """

    def __init__(self, file: BinaryIO, name: str = "capture") -> None:
        """Read from an open binary file; ``name`` is for messages."""
        self.interfaces: list[Interface] = []
        self.application = ""
        self.truncated_at: int | None = None
        self.name = name
        self._file = file
        self._lines: list[_Line] = []
        self._finished: set[int] = set()
        self._endian: Literal["little", "big"] = "little"
        self._packets = self._read()

    @property
    def finished(self) -> bool:
        """See the class."""
        return len(self._finished) == len(self.interfaces) > 0

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
        """Give the file back; there is no need to after the last packet."""
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
                    self._interface(fields)
                elif block.kind == blocks.STATISTICS:
                    self._finished.add(self._line(block, fields).number)
                elif block.kind in (blocks.SIMPLE_PACKET, blocks.OBSOLETE_PACKET):
                    self._refuse(block, "packets of a kind that tell neither time nor direction")
                # What else there may be (names, secrets, things of other programs) is none of ours.
        except Truncated as end:
            self.truncated_at = end.offset
        finally:
            self._file.close()

    def _section(self, block: Block, fields: Fields) -> None:
        _, major, _, _ = fields.numbers("IHHq")
        if major != blocks.VERSION[0]:
            self._refuse(block, f"version {major} of pcapng, which nobody knew when this was made")
        # Indexes of interfaces count from each section's beginning.
        self._lines = []
        self._endian = "little" if block.order == "<" else "big"
        options = dict(fields.options())
        self.application = _text(options.get(blocks.SECTION_APPLICATION, b""))

    def _interface(self, fields: Fields) -> None:
        link_type, _, _ = fields.numbers("HHI")
        options = dict(fields.options())
        description = _text(options.get(blocks.INTERFACE_DESCRIPTION, b""))
        word, _, edition = description.partition(" ")
        speed = int.from_bytes(options.get(blocks.INTERFACE_SPEED, b""), self._endian)
        name = _text(options.get(blocks.INTERFACE_NAME, b""))
        self.interfaces.append(Interface(name, edition if word == "edition" else "", speed))
        resolution = options.get(blocks.INTERFACE_RESOLUTION) or bytes([MICROSECONDS])
        late = options.get(blocks.INTERFACE_OFFSET, b"")
        seconds = int.from_bytes(late, self._endian, signed=True)
        self._lines.append(_Line(len(self.interfaces) - 1, link_type, resolution[0], seconds))

    def _packet(self, block: Block, fields: Fields) -> Packet:
        line = self._line(block, fields)
        if line.link_type not in blocks.USER_LINK_TYPES:
            self._refuse(block, f"packets of link type {line.link_type}, which is no serial line")
        high, low, size, _ = fields.numbers("IIII")
        data = fields.data(size)
        options = dict(fields.options())
        flags = int.from_bytes(options.get(blocks.PACKET_FLAGS, b""), self._endian)
        packet = Packet(
            line.nanoseconds(high, low),
            DIRECTIONS[flags & 3],
            data,
            # Only we cut at frames, and say so of what is none.
            "frame" if self.application.startswith(OURS) else "bytes",
            interface=line.number,
        )
        return with_comment(packet, _text(options.get(blocks.COMMENT, b"")))

    def _line(self, block: Block, fields: Fields) -> _Line:
        (index,) = fields.numbers("I")
        if index >= len(self._lines):
            self._refuse(block, f"damaged: nothing introduces its interface {index}")
        return self._lines[index]

    def _refuse(self, block: Block, why: str) -> NoReturn:
        raise CaptureError(self.name, block.offset, why)


def _text(value: bytes) -> str:
    return value.rstrip(b"\0").decode("utf-8", "replace")
