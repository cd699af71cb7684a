"""Describes an edition's frames for C: where their parts are, and how their check is computed."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire_codegen.catalogue import Crc
from cobotwire_codegen.model import Edition, FrameNumber


@dataclass(frozen=True, slots=True)
class Unsigned:
    """An unsigned number of a frame as C reads and writes it."""

    at: str
    width: int
    order: str

    def read(self, data: str) -> str:
        """Return the expression for the number."""
        shifted = [
            f"{data}[{self._index(byte)}]" + (f" << {8 * byte}" if byte else "")
            for byte in reversed(range(self.width))
        ]
        return f"(unsigned)({' | '.join(shifted)})" if self.width > 1 else shifted[0]

    def written(self, out: str, number: str) -> list[str]:
        """Return the statements that write a number; it is a name or a call."""
        if self.width == 1:
            return [f"{out}[{self.at}] = (uint8_t){number};"]
        shifted = [number if byte == 0 else f"{number} >> {8 * byte}" for byte in range(self.width)]
        return [
            f"{out}[{self._index(byte)}] = (uint8_t)({part} & 0xFFu);"
            for byte, part in enumerate(shifted)
        ]

    def _index(self, byte: int) -> str:
        place = byte if self.order == "little" else self.width - 1 - byte
        if self.at == "0":
            return str(place)
        return f"{self.at} + {place}u" if place else self.at


@dataclass(frozen=True, slots=True)
class CrcRegister:
    """The constants of a CRC for a register of whole bytes."""

    crc: Crc

    @property
    def bits(self) -> int:
        """The width of the register: at least a byte."""
        return max(self.crc.width, 8)

    @property
    def c_type(self) -> str:
        """The C type of the register."""
        return "unsigned" if self.bits <= 16 else "uint32_t" if self.bits <= 32 else "uint64_t"

    def constant(self, number: int) -> str:
        """Return a constant of the register's type."""
        digits = f"0x{number:0{(self.bits + 3) // 4}X}"
        kinds = {"unsigned": f"{digits}u", "uint32_t": f"UINT32_C({digits})"}
        return kinds.get(self.c_type, f"UINT64_C({digits})")

    @property
    def initial(self) -> str:
        """The first content of the register."""
        return self.constant(self._placed(self.crc.init))

    @property
    def polynomial(self) -> str:
        """The polynomial in the order of the register's bits."""
        return self.constant(self._placed(self.crc.poly))

    @property
    def top(self) -> str:
        """The bit that leaves the register."""
        return self.constant(1 << self.bits - 1)

    @property
    def mask(self) -> str:
        """All bits of the register."""
        return self.constant((1 << self.bits) - 1)

    @property
    def mirrored(self) -> bool:
        """Whether the bits of the result are reversed."""
        return self.crc.refin != self.crc.refout

    def _placed(self, number: int) -> int:
        if self.crc.refin:
            return int(f"{number:0{self.crc.width}b}"[::-1], 2)
        return number << self.bits - self.crc.width


class FrameFacts:
    """Where the parts of an edition's frames are; offsets are those of requests."""

    def __init__(self, edition: Edition) -> None:
        frame = self.frame = edition.frame
        self.sizes = frame.sizes
        self.parts = frame.layout if frame.address_values else _without_address(frame.layout)
        self.length_first = frame.layout.index("length") < frame.layout.index("command")
        self.overhead = frame.data_at("request") + frame.check_size - frame.length(0)
        self.data_at = {each: frame.data_at(each) for each in ("request", "reply")}
        head = max(frame.offset(part) + frame.sizes[part] for part in ("length", "command"))
        self.longest = max(self.overhead + frame.maximum_length, head)
        self.length = _unsigned("LENGTH_AT", frame.length_number)
        self.id = _unsigned("ID_AT", frame.command_number)
        check = frame.check
        self.check = check and Unsigned("0", check.width, check.order)
        self.crc = CrcRegister(check.crc) if check and check.crc else None
        self.check_from = frame.offset(check.covers_from) if check else 0
        self.named = [address.value for address in frame.addresses]
        self.address_range = frame.address_range


def _without_address(layout: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(part for part in layout if part != "address")


def _unsigned(at: str, number: FrameNumber) -> Unsigned:
    return Unsigned(at, number.width, number.order)
