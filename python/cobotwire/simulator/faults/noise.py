"""The catalogue of noise: what real lines carry besides replies, according to the field notes.

This is the only source of noise. The fault ``noise`` sends it, the tests of framing and diagnosis
read it, and the benchmarks damage streams with it. A new class of noise is one function here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from random import Random
from typing import Final, NamedTuple

from cobotwire.protocol.table import Table

COMMAND_ERROR: Final = b"cmd_len error\r\n"


def servo_packet(body: bytes) -> bytes:
    """Return a packet of the servo bus, with its checksum.

    ``body`` is the servo's id, LEN, an instruction or error byte, and the parameters. The checksum
    is the complement of the sum of all bytes after FF FF.
    """
    return b"\xff\xff" + body + bytes([~sum(body) & 0xFF])


LEAKS: Final[Mapping[str, bytes]] = {
    # ID 1, LEN 4, READ, register 0x38, 2 bytes.
    "read": servo_packet(bytes.fromhex("01 04 02 38 02")),
    "status": servo_packet(bytes.fromhex("01 04 00 FF 07")),
    "sync read": servo_packet(bytes.fromhex("FE 0A 82 38 0F 01 02 03 04 05 06")),
    # The notes show eight bytes of this packet; the rest is a position and a speed.
    "sync write": servo_packet(bytes.fromhex("FE 0C 83 29 07 06 08 00 00 00 00 F4 01")),
    "ping": servo_packet(bytes.fromhex("07 02 01")),
    # Reads 0xC2 bytes: the sum is 0x101, the checksum FE. Before a frame: FE FE FE LEN.
    "checksum FE": servo_packet(bytes.fromhex("01 04 02 38 C2")),
}
"""Packets of the servo bus as they were seen on hosts' lines."""


def _register_dump(lines: int) -> str:
    """Return a dump of registers, four in each line, and of the stack after them."""
    names = ["PC", "PS", *(f"A{number}" for number in range(16)), "SAR", "EXCCAUSE", "EXCVADDR"]
    names += ["LBEG", "LEND", "LCOUNT"]
    names += [f"M{place:03d}" for place in range(4 * lines - len(names))]
    values = [0x400D15F4 + 52 * place for place in range(4 * lines)]
    values[names.index("EXCVADDR")] = 4
    cells = [f"{name:<8}: 0x{value:08x}" for name, value in zip(names, values)]
    return "".join(
        "  ".join(cells[start : start + 4]) + "\r\n" for start in range(0, len(cells), 4)
    )


# About 2.4 kB, as in the field notes.
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
LOG: Final = (
    b"wifi: connecting\r\n",
    b"load:0x3fff0030,len:1184\r\n",
    b"entry 0x400805e4\r\n",
    b"I (312) cpu_start: Starting scheduler on PRO CPU.\r\n",
    b"\x1b[0;33mW (1520) wifi: reconnecting\x1b[0m\r\n",
)
"""Lines that firmware of an ESP32 prints while it starts and works. None reports an error."""


def at_other_rate(data: bytes, ratio: float) -> bytes:
    """Return what a receiver reads at ``ratio`` times the baud rate of the sender.

    A byte is a start bit, eight data bits with the lowest first, and a stop bit. The receiver takes
    a falling level for a start bit, and samples each of its own bits in the middle.
    """
    levels = [bit for byte in data for bit in (0, *(byte >> n & 1 for n in range(8)), 1)]
    received = bytearray()
    place = 0.0
    while (start := _falling_edge(levels, place)) is not None:
        at = [(start + (1.5 + bit) / ratio) for bit in range(8)]
        received.append(sum(_level(levels, when) << bit for bit, when in enumerate(at)))
        place = start + 9.5 / ratio
    return bytes(received)


def _level(levels: list[int], at: float) -> int:
    return levels[int(at)] if int(at) < len(levels) else 1


def _falling_edge(levels: list[int], start: float) -> int | None:
    """Return the time of the next falling edge, in bit times of the sender.

    None if there is no other.
    """
    for place in range(max(0, int(start)), len(levels)):
        if place >= start and not levels[place] and (place == 0 or levels[place - 1]):
            return place
    return None


Draw = Callable[[Random, Table], bytes]


class NoiseClass(NamedTuple):
    """One class of noise.

    Attributes:
        draw: returns one piece, drawn with a generator of random numbers.
        weight: how often the class is drawn for a mixture, relative to others; 0: only if it is
            named.
        before_frames: whether it occurs only before frames, not at any place.
    """

    draw: Draw
    weight: float
    before_frames: bool


NOISE: Final[dict[str, NoiseClass]] = {}


def _noise(
    name: str, weight: float = 0.0, *, before_frames: bool = False
) -> Callable[[Draw], Draw]:
    """Register a function that draws one piece of a class of noise."""

    def register(draw: Draw) -> Draw:
        NOISE[name] = NoiseClass(draw, weight, before_frames)
        return draw

    return register


def mixed_noise(random: Random, table: Table) -> bytes:
    """Draw one piece of line noise: of any class, by the weights."""
    (chosen,) = random.choices(list(NOISE.values()), [each.weight for each in NOISE.values()])
    return chosen.draw(random, table)


@_noise("servo", 6)
def _servo(random: Random, table: Table) -> bytes:
    """Draw a servo packet: any id, a known instruction, up to twelve parameters."""
    count = random.randrange(13)
    instruction = random.choice(b"\x01\x02\x03\x04\x05\x82\x83\x00")
    body = bytes([random.randrange(255), count + 2, instruction])
    return servo_packet(body + random.randbytes(count))


@_noise("servo FE", before_frames=True)
def _servo_with_header_byte(random: Random, table: Table) -> bytes:
    """Draw a servo packet with the checksum FE: a frame after it then reads FE FE FE LEN."""
    count = random.randrange(9)
    body = bytes([random.randrange(255), count + 3, 3]) + random.randbytes(count)
    return servo_packet(body + bytes([(0x01 - sum(body)) & 0xFF]))


@_noise("command error", 2)
def _command_error(random: Random, table: Table) -> bytes:
    """Draw the firmware's error text for a malformed request, up to three times."""
    return COMMAND_ERROR * random.randrange(1, 4)


@_noise("log")
def _log(random: Random, table: Table) -> bytes:
    """Draw a line that the firmware prints while it works: no error, no reboot."""
    return random.choice(LOG)


@_noise("panic")
def _panic(random: Random, table: Table) -> bytes:
    """Return the dump of a panic, and the NULs of the reboot after it."""
    return PANIC + bytes(REBOOT_NULS)


@_noise("text")
def _text(random: Random, table: Table) -> bytes:
    """Draw text of the firmware: mostly an error text, sometimes a panic."""
    return (_panic if random.random() < 0.02 else _command_error)(random, table)


@_noise("nuls", 1)
def _nuls(random: Random, table: Table) -> bytes:
    """Draw up to forty NULs."""
    return bytes(random.randrange(1, 41))


@_noise("header bytes", 3, before_frames=True)
def _header_bytes(random: Random, table: Table) -> bytes:
    """Draw up to four FE, the remains of a servo's checksum or of a frame that was cut."""
    return b"\xfe" * random.randrange(1, 5)


@_noise("false header", 3, before_frames=True)
def _false_header(random: Random, table: Table) -> bytes:
    """Draw header, LEN and id of a legal reply, without the rest of the frame."""
    command, variant = random.choice(
        [(command, variant) for command in table.commands for variant in command.reply]
    )
    length = table.frame.length(variant.size, "reply")
    return table.frame.start(command.id, length, direction="reply")


@_noise("garbage", 3)
def _garbage(random: Random, table: Table) -> bytes:
    """Draw up to sixteen bytes of any value."""
    return random.randbytes(random.randrange(1, 17))


@_noise("byte")
def _byte(random: Random, table: Table) -> bytes:
    """Draw one byte of any value."""
    return random.randbytes(1)


@_noise("frame bytes", 3)
def _frame_bytes(random: Random, table: Table) -> bytes:
    """Draw eight bytes that are frequent in frames: FE, FA, short lengths, known ids."""
    return bytes(random.choices(b"\xfe\xfe\xfe\xfa\x03\x04\x0e\x12\x20", k=8))


@_noise("ack", before_frames=True)
def _late_ack(random: Random, table: Table) -> bytes:
    """Return a late acknowledgement of power_on: a frame, where the edition has such acks."""
    return b"\xfe\xfe\x03\x10\x01\xfa"


@_noise("other baud rate")
def _other_baud_rate(random: Random, table: Table) -> bytes:
    """Draw what a receiver reads of up to sixteen bytes sent at a quarter of its baud rate."""
    return at_other_rate(random.randbytes(random.randrange(1, 17)), 4)
