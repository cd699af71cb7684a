"""The bytes that end a frame."""

from __future__ import annotations

from cobotwire.table import FrameFormat


def check(frame: FrameFormat, body: bytes) -> bytes:
    """What must follow ``body``: header, address, LEN, CMD and DATA."""
    if frame.check == "footer":
        return frame.footer
    if frame.check == "sum":
        return bytes([sum(body[frame.overhead :]) & 0xFF])
    return crc16_modbus(body).to_bytes(2, "big")


def crc16_modbus(data: bytes) -> int:
    """CRC-16/MODBUS: polynomial 0x8005 reflected, start FFFF; 4B37 for ``123456789``."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc
