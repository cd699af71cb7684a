"""Interpret the blocks of a pcapng file: sections, interfaces, packets and statistics."""

from __future__ import annotations

from typing import Literal, NamedTuple, NoReturn

from cobotwire.capture import block_encoding as blocks
from cobotwire.capture.block_parsing import Block, Fields
from cobotwire.capture.damage import MOST_INTERFACES, damaged
from cobotwire.capture.packet import Direction, Interface, Packet, with_comment

DIRECTIONS: tuple[Direction, ...] = ("unknown", "received", "sent", "unknown")
MICROSECONDS = 6
# Files of other applications hold raw chunks; ours hold frames and noise.
OURS = "cobotwire"
# The end of the application's name in a recording without times. All its packets have the time 0.
UNTIMED = " (no times)"
# The end of that name in a recording with times from an unknown start, which have no date.
UNDATED = " (no dates)"


class _Format(NamedTuple):
    """How to read the packets of one interface."""

    number: int
    link_type: int
    resolution: int
    offset_seconds: int

    @property
    def _units(self) -> int:
        """The number of time stamps in a second."""
        exponent = self.resolution & 0x7F
        units: int = 2**exponent if self.resolution & 0x80 else 10**exponent
        return units

    def nanoseconds(self, ticks: int) -> int:
        """Return a time stamp in nanoseconds; finer fractions are cut off."""
        return ticks * 1_000_000_000 // self._units + self.offset_seconds * 1_000_000_000

    def ticks(self, time_ns: int) -> int:
        """Return the first time stamp that is not before a time in nanoseconds."""
        return -(-(time_ns - self.offset_seconds * 1_000_000_000) * self._units // 1_000_000_000)


class PacketParser:
    """Turns the blocks of a file into packets.

    Attributes:
        name: the name of the file, for messages.
        interfaces: the interfaces that the blocks so far describe.
        application: the name of the program that wrote the capture.
        link_types: the link types of the interfaces.
    """

    def __init__(self, name: str, *, any_link: bool = False) -> None:
        """Read a file of that name; ``any_link`` also takes packets that are not serial."""
        self.name = name
        self.link_types: list[int] = []
        self._any_link = any_link
        self.interfaces: list[Interface] = []
        self.application = ""
        self._formats: list[_Format] = []
        self._finished: set[int] = set()
        self._endian: Literal["little", "big"] = "little"

    @property
    def finished(self) -> bool:
        """Whether each interface has its statistics, which the recorder writes at the end."""
        return len(self._finished) == len(self.interfaces) > 0

    def take(self, block: Block) -> Packet | None:
        """Interpret the next block; return its packet if it is one.

        Raises:
            CaptureError: the block is damaged, or it belongs to a recording of another kind.
        """
        fields = Fields(block, self.name)
        if block.kind == blocks.PACKET:
            return self._packet(block, fields)
        if block.kind == blocks.SECTION:
            self._section(block, fields)
        elif block.kind == blocks.INTERFACE:
            self._interface(block, fields)
        elif block.kind == blocks.STATISTICS:
            self._finished.add(self._format(block, fields).number)
        elif block.kind in (blocks.SIMPLE_PACKET, blocks.OBSOLETE_PACKET):
            self._reject(block, "no-time")
        # Other blocks (names, secrets, private ones) are skipped.
        return None

    def stamp(self, block: Block) -> tuple[int, int]:
        """Return the index of a packet's interface in its section, and its time stamp.

        The packet may have any link type.

        Raises:
            CaptureError: the block is damaged.
        """
        fields = Fields(block, self.name)
        index, high, low, size, _ = fields.numbers("IIIII")
        if index >= len(self._formats):
            self._reject(block, "no-interface", index)
        fields.data(size)
        for _ in fields.options():
            pass
        return index, high << 32 | low

    def time_ns(self, block: Block) -> int:
        """Return the time of a packet in nanoseconds; see :meth:`stamp`."""
        index, ticks = self.stamp(block)
        return self._formats[index].nanoseconds(ticks)

    def ticks(self, time_ns: int) -> list[int]:
        """Return a time as the first time stamp at or after it, for each interface of a section."""
        return [format.ticks(time_ns) for format in self._formats]

    def _section(self, block: Block, fields: Fields) -> None:
        _, major, _, _ = fields.numbers("IHHq")
        if major != blocks.VERSION[0]:
            self._reject(block, "version", major)
        # Interface indexes start from 0 in each section.
        self._formats = []
        self._endian = "little" if block.order == "<" else "big"
        options = dict(fields.options())
        self.application = decoded(options.get(blocks.SECTION_APPLICATION, b""))

    def _interface(self, block: Block, fields: Fields) -> None:
        if len(self.interfaces) >= MOST_INTERFACES:
            self._reject(block, "many-interfaces")
        link_type, _, _ = fields.numbers("HHI")
        options = dict(fields.options())
        for code in (blocks.INTERFACE_SPEED, blocks.INTERFACE_OFFSET):
            if len(options.get(code, b"")) > blocks.NUMBER_SIZE:
                self._reject(block, "long-number")
        name = options.get(blocks.INTERFACE_NAME, b"")
        description = options.get(blocks.INTERFACE_DESCRIPTION, b"")
        speed = int.from_bytes(options.get(blocks.INTERFACE_SPEED, b""), self._endian)
        self.interfaces.append(interface_of(name, description, speed))
        self.link_types.append(link_type)
        resolution = options.get(blocks.INTERFACE_RESOLUTION) or bytes([MICROSECONDS])
        offset = options.get(blocks.INTERFACE_OFFSET, b"")
        seconds = int.from_bytes(offset, self._endian, signed=True)
        self._formats.append(_Format(len(self.interfaces) - 1, link_type, resolution[0], seconds))

    def _packet(self, block: Block, fields: Fields) -> Packet:
        format = self._format(block, fields)
        if format.link_type not in blocks.USER_LINK_TYPES and not self._any_link:
            self._reject(block, "link-type", format.link_type)
        high, low, size, _ = fields.numbers("IIII")
        data = fields.data(size)
        options = dict(fields.options())
        flags = int.from_bytes(options.get(blocks.PACKET_FLAGS, b""), self._endian)
        packet = Packet(
            format.nanoseconds(high << 32 | low),
            DIRECTIONS[flags & 3],
            data,
            "frame" if self.application.startswith(OURS) else "bytes",
            interface=format.number,
        )
        return with_comment(packet, decoded(options.get(blocks.COMMENT, b"")))

    def _format(self, block: Block, fields: Fields) -> _Format:
        (index,) = fields.numbers("I")
        if index >= len(self._formats):
            self._reject(block, "no-interface", index)
        return self._formats[index]

    def _reject(self, block: Block, kind: str, *numbers: int) -> NoReturn:
        raise damaged(self.name, block.offset, kind, *numbers)


def interface_of(name: bytes, description: bytes, speed: int) -> Interface:
    """Return the interface that a block describes."""
    key, _, edition = decoded(description).partition(" ")
    return Interface(decoded(name), edition if key == "edition" else "", speed)


def decoded(value: bytes) -> str:
    """Return the text of an option."""
    return value.rstrip(b"\0").decode("utf-8", "replace")
