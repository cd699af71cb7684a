"""Tables in the maker's other frame formats, and one with variants distinguished by their values.

No edition uses them yet. CRC and SUM follow the maker's other robots; ALIKE has variants that share
an id and a size.
"""

from __future__ import annotations

from cobotwire.protocol.table import (
    Case,
    Check,
    Command,
    Crc,
    Field,
    FrameFormat,
    Number,
    Table,
    Variant,
)

HEADER = b"\xfe\xfe"
CRC16_MODBUS = Check("crc", "header", 2, "big", Crc(16, 0x8005, 0xFFFF, True, True, 0))
SUM_OF_DATA = Check("sum", "command")


def _byte(name: str, minimum: int = 0, maximum: int = 255, *choices: int) -> Field:
    number = Number("", 1, "big", 255, 1, 1, minimum, maximum, "")
    return Field(name, "number", (Case((), (number,)),), "", choices=choices)


def _words(name: str, count: int, width: int, divide: int) -> Field:
    top = 256**width // 2
    number = Number("", width, "big", top - 1, 1, divide, -top, top - 1, "")
    return Field(name, "number", (Case((), (number,) * count),), "", many=True)


def _command(id: int, name: str, request: tuple[Variant, ...], *reply: Variant) -> Command:
    return Command(id, name, "", "", "test", "query", 100, request, reply)


NOTHING = (Variant(()),)
STATUS = Variant((_byte("status"),))
SET = Variant((_byte("servo"), _byte("status")))
CRC = Table(
    "mercury",
    "The format with a CRC",
    6,
    115200,
    FrameFormat(HEADER, b"", 40, CRC16_MODBUS),
    (
        _command(0x58, "set_free_mode", (STATUS,), STATUS, SET),
        _command(0x6E, "get_robot_status", NOTHING, STATUS),
        _command(0x4D, "set_break", (STATUS,), SET),
        _command(0x4C, "set_speed", (SET,), Variant((_byte("mode"), _words("speed", 1, 2, 1)))),
        _command(0x5B, "motion_end", NOTHING, STATUS),
        _command(0x20, "get_angles", NOTHING, Variant((_words("angles", 6, 4, 1000),))),
        _command(0x22, "send_angles", (Variant((_words("angles", 6, 2, 100), _byte("speed"))),)),
    ),
)
SUM = Table(
    "mybuddy",
    "The format with an address and a sum",
    6,
    115200,
    FrameFormat(HEADER, b"", 16, SUM_OF_DATA, (1, 0, 2, 3)),
    (
        _command(0x10, "power_on", NOTHING),
        _command(0x12, "is_power_on", NOTHING, STATUS),
        _command(0x20, "get_angles", NOTHING, Variant((_words("angles", 6, 2, 100),))),
        _command(0x22, "send_angles", (Variant((_words("angles", 6, 2, 100), _byte("speed"))),)),
    ),
)
# Commands with the same id and size, distinguished by a constant, by bounds, or not at all.
ALIKE = Table(
    "alike",
    "Messages that share an id and a size",
    6,
    115200,
    FrameFormat(HEADER, b"\xfa", 16),
    (
        _command(0x60, "set_left", (Variant((_byte("side", 0, 255, 1), _byte("value", 0, 99))),)),
        _command(0x60, "set_right", (Variant((_byte("side", 0, 255, 2), _byte("value", 0, 99))),)),
        _command(0x61, "jog", (Variant((_byte("low", 0, 9),)), Variant((_byte("high", 20, 29),)))),
        _command(0x61, "jog_too", (Variant((_byte("any"),)),), STATUS),
    ),
)
