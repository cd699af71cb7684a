"""Define the frame around the data bytes of a message, and the rules for its LEN and its check."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Check = Literal["footer", "crc16-modbus", "sum"]


@dataclass(frozen=True, slots=True)
class FrameFormat:
    """``header [address] LEN CMD DATA check``; LEN counts CMD, DATA and check.

    ``check`` is a fixed ``footer``; or a CRC-16/MODBUS over everything before it, high byte first;
    or the low byte of the sum of CMD and DATA. If ``addresses`` is not empty, every frame has an
    address byte, which is one of them. The first one is sent unless the caller chooses another.
    """

    header: bytes
    footer: bytes
    maximum_length: int
    check: Check = "footer"
    addresses: tuple[int, ...] = ()

    def length(self, data_size: int) -> int:
        """Return LEN of a frame with ``data_size`` data bytes."""
        return 1 + data_size + self.check_size

    @property
    def check_size(self) -> int:
        """The number of bytes of the check."""
        if self.check == "footer":
            return len(self.footer)
        return 2 if self.check == "crc16-modbus" else 1

    @property
    def length_at(self) -> int:
        """The offset of LEN in a frame; CMD follows LEN."""
        return len(self.header) + (1 if self.addresses else 0)

    @property
    def overhead(self) -> int:
        """The number of bytes that LEN does not count: header, address and LEN itself."""
        return self.length_at + 1

    def data(self, frame: bytes) -> bytes:
        """Return the data bytes of a frame, between CMD and the check."""
        return frame[self.overhead + 1 : len(frame) - self.check_size]

    def address(self, frame: bytes) -> int | None:
        """Return the address byte of a frame; None if the format has no addresses."""
        return frame[self.length_at - 1] if self.addresses else None

    def end(self, body: bytes) -> bytes:
        """Return the check that must follow ``body``: header, address, LEN, CMD and DATA."""
        if self.check == "footer":
            return self.footer
        if self.check == "sum":
            return bytes([sum(body[self.overhead :]) & 0xFF])
        return crc16_modbus(body).to_bytes(2, "big")


def crc16_modbus(data: bytes) -> int:
    """Return the CRC-16/MODBUS: reflected polynomial 0x8005, initial value 0xFFFF.

    The CRC of ``123456789`` is 0x4B37.
    """
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc
