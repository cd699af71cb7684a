"""The frame format, with the settings of the transport."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import Literal

from cobotwire_codegen.catalogue import Crc
from cobotwire_codegen.errors import Place

Order = Literal["big", "little"]
Direction = Literal["request", "reply"]
_USUAL_CHECKS = (("crc16-modbus", "header", 2, "big"), ("sum", "command", 1, "big"))


@dataclass(frozen=True, slots=True)
class Address:
    """A value of the address byte, and from which address the replies to it come.

    ``joints`` is the number of the device's joints; 0: as many as the edition.
    """

    place: Place
    name: str
    value: int
    doc: str
    replies: str
    joints: int = 0

    @property
    def attribute(self) -> str:
        """The name of the attribute of a client that holds the client for this address."""
        return self.name.lower()


@dataclass(frozen=True, slots=True)
class FrameCheck:
    """A number computed from the frame; ``crc`` are its parameters if it is a CRC."""

    word: str
    covers_from: str
    width: int
    order: Order
    crc: Crc | None


@dataclass(frozen=True, slots=True)
class FrameNumber:
    """LEN or CMD: an unsigned number of one or two bytes."""

    width: int = 1
    order: Order = "big"


@dataclass(frozen=True)  # without slots, for the cached properties
class Frame:
    """The frame format and the transport.

    A frame is the header, the fixed parts in the order of ``layout``, data, the check, the footer.
    LEN is the size of the parts in ``counted``.
    """

    place: Place
    header: bytes
    check: FrameCheck | None
    footer: bytes
    addresses: tuple[Address, ...]
    maximum_data: int
    doc: str
    baudrate: int
    deadline_ms: int
    address_range: tuple[int, ...] = ()
    layout: tuple[str, ...] = ("address", "length", "command")
    counted: tuple[str, ...] = ("command", "data", "check", "footer")
    length_number: FrameNumber = FrameNumber()
    command_number: FrameNumber = FrameNumber()
    replies_have_command: bool = True

    @cached_property
    def address_values(self) -> tuple[int, ...]:
        """Every legal address byte; the first one is sent unless the caller chooses another."""
        named = tuple(address.value for address in self.addresses)
        return named + tuple(value for value in self.address_range if value not in named)

    def address_in(self, data: bytes) -> int | None:
        """Return the address that a frame carries; None if it has no legal one."""
        found = data[self.offset("address") :][:1] if self.address_values else b""
        return found[0] if found and found[0] in self.address_values else None

    @property
    def check_word(self) -> str:
        """The spec's word for the check."""
        return self.check.word if self.check else "footer"

    @property
    def check_size(self) -> int:
        """The number of bytes of check and footer."""
        return self.sizes["check"] + self.sizes["footer"]

    @cached_property
    def sizes(self) -> dict[str, int]:
        """The size of each part except the data."""
        return {
            "header": len(self.header),
            "address": 1 if self.address_values else 0,
            "length": self.length_number.width,
            "command": self.command_number.width,
            "check": self.check.width if self.check else 0,
            "footer": len(self.footer),
        }

    def offset(self, part: str) -> int:
        """Return where a part of a request starts; the part is not check or footer."""
        return self._offsets[part]

    @cached_property
    def _offsets(self) -> dict[str, int]:
        order = ("header", *self.layout, "data")
        ends = accumulate((self.sizes[part] for part in order[:-1]), initial=0)
        return dict(zip(order, ends))

    def data_at(self, direction: Direction) -> int:
        """Return the offset of the data; frames without an id have data at the offset of the id."""
        return self.offset("data" if self.has_command(direction) else "command")

    def has_command(self, direction: Direction) -> bool:
        """Return whether frames of that direction carry a command id."""
        return self.replies_have_command or direction == "request"

    def length(self, data_size: int, direction: Direction = "request") -> int:
        """Return LEN of a frame with that many data bytes."""
        absent = 0 if self.has_command(direction) else self.sizes["command"]
        # In a reply without an id, the data starts at the id's offset, so the id's bytes are not
        # counted. Frames with equal LEN therefore have equal size in both directions.
        return self._counted_size + data_size - absent

    @cached_property
    def _counted_size(self) -> int:
        return sum(self.sizes.get(part, 0) for part in self.counted)

    @property
    def maximum_length(self) -> int:
        """The highest LEN of a frame."""
        return self.length(self.maximum_data)

    @property
    def usual(self) -> bool:
        """Whether LEN and CMD are a byte each after the header, and LEN counts all after itself.

        The maker's robots use such frames. They end with a footer, a CRC-16/MODBUS or a sum.
        """
        check = self.check
        if check is None:
            ended = len(self.footer) == 1
        else:
            kind = (check.word, check.covers_from, check.width, check.order)
            ended = not self.footer and kind in _USUAL_CHECKS
        ending = "footer" if check is None else "check"
        return (
            ended
            and len(self.header) == 2
            and set(self.counted) == {"command", "data", ending}
            and self.layout == ("address", "length", "command")
            and (self.length_number, self.command_number) == (FrameNumber(), FrameNumber())
            and self.replies_have_command
            and not self.address_range
        )
