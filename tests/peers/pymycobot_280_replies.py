"""Read replies with MyCobot280 and with our client, and list where the results differ."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from cobotwire.codec import CodecName
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.editions.mycobot280 import MyCobot280 as OurMyCobot280
from cobotwire.protocol.errors import ReplyTimeout
from cobotwire.protocol.table import Command
from pymycobot_280_requests import REQUESTS
from pymycobot_classes import peer_on
from pymycobot_difference import M280
from pymycobot_ports import ReplyingPort, ReplyingTransport


def arguments_for(command: Command, echoed: dict[str, Any]) -> tuple[Any, ...]:
    """Return arguments of a request that matches a reply with these echoes."""
    arguments = list(REQUESTS[command.name][0])
    for index, field in enumerate(command.request[0].fields):
        if field.name in echoed:
            arguments[index] = echoed[field.name]
    return tuple(arguments)


def read_by_us(codec: CodecName, command: str, arguments: Iterable[Any], frame: bytes) -> Any:
    """Return our client's result for a reply, as plain lists and numbers."""
    with OurMyCobot280(ReplyingTransport(frame), codec=codec, timeout=0.05) as client:
        return plain(getattr(client, command)(*arguments))


def read_by_pymycobot(command: str, arguments: Iterable[Any], frame: bytes) -> Any:
    """Return what pymycobot itself reads from the reply."""
    return getattr(peer_on(M280, ReplyingPort(frame)), command)(*arguments)


def plain(value: Any) -> Any:
    """Return a value of ours without field names."""
    if isinstance(value, tuple):
        return [plain(item) for item in value]
    return int(value) if isinstance(value, int) else value


def bits(byte: int) -> Any:
    """Return the numbers of the bits that are set, or 0 if none is."""
    return [bit for bit in range(8) if byte >> bit & 1] or 0


def _error_class(byte: int) -> int:
    for known, codes in ((1, range(16, 23)), (2, range(23, 29)), (3, range(32, 112))):
        if byte in codes:
            return known
    return byte


def _errors(ours: list[int]) -> list[Any]:
    if len(ours) == 7:
        return [bits(_error_class(byte)) for byte in ours]
    data = bytes(ours)
    return [int.from_bytes(data[at : at + 2], "big", signed=True) for at in (0, 2, 4)]


def _points(ours: list[int]) -> Any:
    return [ours[::2], ours[1::2]] if any(ours) else -1


# The ruling, and pymycobot's result as a function of ours.
OtherResult = tuple[str, Callable[[Any], Any]]

DIFFERENCES: dict[str, OtherResult] = {
    "get_radians": (
        "0x20: the float nearest to the angle; pymycobot rounds it to thousandths",
        lambda ours: [round(math.degrees(value) * (math.pi / 180), 3) for value in ours],
    ),
    "get_angles_coords": (
        "0xD5: angles and coordinates, each by name; pymycobot gives one list of twelve",
        lambda ours: ours[0] + ours[1],
    ),
    "get_servo_status": (
        "0xE4: the byte as it comes; pymycobot gives lists of bit numbers, and prints them",
        lambda ours: [bits(byte) for byte in ours],
    ),
    "read_next_error": (
        "0x15: 7 or 6 bytes, as they come, never words; pymycobot sorts 7 bytes into classes and "
        "gives their bit numbers, and reads 6 bytes as three words",
        _errors,
    ),
    "drag_get_record_data": (
        "0xF3: the words in their order, zeros too; pymycobot gives two lists, and -1 for zeros",
        _points,
    ),
}


class OtherReading(NamedTuple):
    """A reply that the two sides read differently; an exception is given as its type.

    ``ours`` is our client's result; for a setter, which does not wait, the decoded fields.
    """

    call: str
    arguments: tuple[Any, ...]
    reply: bytes
    ours: Any
    theirs: Any
    ruling: str


_ONE_BYTE = "0x62 0xA1: older firmware leaves the pin out; pymycobot skips a byte in any case"
_OF_ANOTHER = "a reply is matched by its echo; pymycobot takes the reply for any joint or pin"
_BARE = "an acknowledgement may be a bare frame; pymycobot reads -1 from a frame without data"
_ANY = "0xA0: the value as received; pymycobot always returns 1"
_SPACES = "0xB1: both parts may contain spaces; pymycobot takes the first and the last word"
_LINE_END = "0xB1: the text ends with silence, and a line end is not part of it"
_PRINTED = b"ssid: my home password: two words"


def _frame(text: str) -> bytes:
    return bytes.fromhex(text)


OTHER_READINGS = [
    OtherReading("get_digital_input", (23,), _frame("FEFE036201FA"), 1, struct.error, _ONE_BYTE),
    OtherReading("get_basic_input", (5,), _frame("FEFE03A101FA"), 1, struct.error, _ONE_BYTE),
    *(
        OtherReading(call, (argument,), _frame(reply), ReplyTimeout, theirs, _OF_ANOTHER)
        for call, argument, reply, theirs in [
            ("get_joint_min_angle", 1, "FE FE 05 4A 02 06 0E FA", 155.0),
            ("get_joint_max_angle", 1, "FE FE 05 4B 02 06 0E FA", 155.0),
            ("is_servo_enable", 1, "FE FE 04 50 02 01 FA", 1),
            ("get_digital_input", 23, "FE FE 04 62 21 01 FA", 1),
            ("get_basic_input", 5, "FE FE 04 A1 02 01 FA", 1),
        ]
    ),
    OtherReading("set_basic_output", (5, 1), _frame("FEFE03A000FA"), {"done": 0}, 1, _ANY),
    *(
        OtherReading(
            command.name,
            REQUESTS[command.name][0],
            bytes([0xFE, 0xFE, 2, command.id, 0xFA]),
            {},
            -1,
            _BARE,
        )
        for command in TABLE.commands
        if command.ack
    ),
    OtherReading("get_ssid_pwd", (), _PRINTED, ["my home", "two words"], ("my", "words"), _SPACES),
    OtherReading(
        "get_ssid_pwd", (), b"ssid: a password: b\r\n", ["a", "b"], ("a", "b\r\n"), _LINE_END
    ),
]

ACKS = [command for command in TABLE.commands if command.ack]
REPLIES = [command for command in TABLE.commands if command.reply and not command.ack]
