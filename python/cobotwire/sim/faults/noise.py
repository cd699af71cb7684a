"""What a line carries that is nobody's answer, as field notes have it.

The one source of it: scenarios play it, and the tests of framing and diagnosis are fed with it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

COMMAND_ERROR: Final = b"cmd_len error\r\n"


def servo_packet(body: bytes) -> bytes:
    """A packet of the servo bus: ``body`` is ID, LEN, instruction or error, and parameters.

    The checksum is the complement of the sum of what stands behind FF FF.
    """
    return b"\xff\xff" + body + bytes([~sum(body) & 0xFF])


LEAKS: Final[Mapping[str, bytes]] = {
    # ID 1, LEN 4, READ, register 0x38, 2 bytes.
    "read": servo_packet(bytes.fromhex("01 04 02 38 02")),
    "status": servo_packet(bytes.fromhex("01 04 00 FF 07")),
    "sync read": servo_packet(bytes.fromhex("FE 0A 82 38 0F 01 02 03 04 05 06")),
    # The notes break off behind its eighth byte; the rest is a position and a speed.
    "sync write": servo_packet(bytes.fromhex("FE 0C 83 29 07 06 08 00 00 00 00 F4 01")),
    "ping": servo_packet(bytes.fromhex("07 02 01")),
    # 0xC2 bytes are read: the sum is 0x101, the checksum FE. In front of a frame: FE FE FE LEN.
    "checksum FE": servo_packet(bytes.fromhex("01 04 02 38 C2")),
}

_REGISTERS = ("PC", "PS", *(f"A{number}" for number in range(16)), "SAR", "EXCCAUSE")
_PC = 0x400D15F4


def _register_dump(lines: int) -> str:
    """Registers, four a line, and then the stack; the program counter first."""
    names: list[str] = [*_REGISTERS, "EXCVADDR", "LBEG", "LEND", "LCOUNT"]
    values = [_PC + 52 * place for place in range(4 * lines)]
    values[names.index("EXCVADDR")] = 4
    names += [f"M{place:03d}" for place in range(4 * lines - len(names))]
    cells = [f"{name:<8}: 0x{value:08x}" for name, value in zip(names, values)]
    return "".join(
        "  ".join(cells[start : start + 4]) + "\r\n" for start in range(0, len(cells), 4)
    )


# About 2.4 kB, as seen.
PANIC: Final = (
    "Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n\r\n"
    "Core  1 register dump:\r\n"
    + _register_dump(25)
    + "\r\nBacktrace: 0x400d15f1:0x3ffb1f60 0x400d0b59:0x3ffb1f90 0x40088b9d:0x3ffb1fb0\r\n\r\n"
    "Rebooting...\r\n"
).encode("ascii")
REBOOT_NULS: Final = 277
BOOT: Final = (
    b"ets Jul 29 2019 12:21:46\r\n\r\nrst:0xc (SW_CPU_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\r\n"
)


def at_other_rate(data: bytes, times: float) -> bytes:
    """What a receiver that is so many times faster than the sender makes of bytes.

    Each byte is a start bit, eight bits from the lowest, a stop bit. The receiver takes a fall of
    the level for a start bit and looks at the middle of each of its own bits behind it.
    """
    levels = [bit for byte in data for bit in (0, *(byte >> n & 1 for n in range(8)), 1)]
    heard = bytearray()
    place = 0.0
    while (start := _fall(levels, place)) is not None:
        at = [(start + (1.5 + bit) / times) for bit in range(8)]
        heard.append(sum(_level(levels, when) << bit for bit, when in enumerate(at)))
        place = start + 9.5 / times
    return bytes(heard)


def _level(levels: list[int], at: float) -> int:
    return levels[int(at)] if int(at) < len(levels) else 1


def _fall(levels: list[int], behind: float) -> int | None:
    """Where the level falls next, in bits of the sender."""
    for place in range(max(0, int(behind)), len(levels)):
        if place >= behind and not levels[place] and (place == 0 or levels[place - 1]):
            return place
    return None
