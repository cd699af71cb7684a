"""Recognise what real lines carry besides frames: servo packets, firmware text, damaged frames."""

from __future__ import annotations

from typing import Any

import pytest

from cobotwire.codec.interface import Codec, Frame
from cobotwire.diagnose import (
    CommandError,
    DamagedFrame,
    Garbage,
    Nuls,
    OppositeFrame,
    Panic,
    ServoPacket,
    Text,
    UnlistedFrame,
    Unrecognised,
)
from cobotwire.simulator.faults import noise
from diagnosing import (
    ANGLES,
    FRAME,
    PING,
    READ,
    STATUS,
    SYNC_READ,
    SYNC_WRITE,
    diagnose,
    kinds,
    only,
)

Expected = tuple[type, dict[str, Any]]
A_FRAME: Expected = (Frame, {})
A_PACKET: Expected = (ServoPacket, {})
AN_ERROR: Expected = (CommandError, {})
BACKTRACE = (0x400D15F1, 0x400D0B59, 0x40088B9D)
A_CAUSE: dict[str, Any] = {"core": 1, "cause": "LoadProhibited"}
ERROR = b"cmd_len error\r\n"
REQUEST = bytes.fromhex("FE FE 02 20 FA")
# A servo packet with the checksum FE.
LIKE_A_HEADER = noise.servo_packet(bytes.fromhex("01 04 00 00 fc"))
OLD_PANIC = b"Guru Meditation Error of type StoreProhibited occurred on core  0. Exception was\r\n"
SIX_STATUSES = b"".join(noise.servo_packet(bytes([id, 17, 0]) + bytes(15)) for id in range(1, 7))
SERVOS = (1, 2, 3, 4, 5, 6)
POSITION: dict[str, Any] = {"register": 0x38, "register_name": "present position"}


def servo(role: str = "instruction", **more: Any) -> Expected:
    return ServoPacket, {"role": role, **more}


def item(kind: type, **attributes: Any) -> Expected:
    return kind, attributes


def damaged(command: str | None, reason: str, **more: Any) -> Expected:
    return DamagedFrame, {"command": command, "reason": reason, **more}


def opposite(direction: str, sent: bool = False) -> Expected:
    return OppositeFrame, {"command": "get_angles", "direction": direction, "sent": sent}


# What is received, and each item of the diagnosis with some of its attributes.
EXAMPLES: dict[str, tuple[bytes, list[Expected]]] = {
    # Error bits 0x02 and two bytes of data would look the same.
    "read": (
        READ,
        [servo(servo=1, instruction="read", count=2, ambiguous=True, **POSITION)],
    ),
    "status alone": (
        STATUS,
        [servo("status", error=0, parameters=b"\xff\x07", register=None, ambiguous=False)],
    ),
    # An instruction has one status packet.
    "read and two statuses": (
        READ + STATUS * 2,
        [A_PACKET, servo("status", **POSITION), servo("status", register=None)],
    ),
    "repeated read": (READ * 3, [servo()] * 3),
    "sync read and its statuses": (
        SYNC_READ + SIX_STATUSES,
        [
            servo(servo=0xFE, instruction="sync read", count=15, servos=SERVOS, ambiguous=False),
            *(servo("status", servo=id, register=0x38) for id in SERVOS),
        ],
    ),
    "sync write": (
        SYNC_WRITE,
        [servo(instruction="sync write", register_name="acceleration", count=7, servos=(6,))],
    ),
    "ping": (PING, [servo(instruction="ping", servo=7, register=None)]),
    "status with an error": (
        noise.servo_packet(b"\x03\x02\x20"),
        [servo("status", error=0x20, errors=("overload",), ambiguous=False)],
    ),
    "servo packets between frames": (
        READ + FRAME + STATUS + SYNC_READ + ANGLES + PING,
        [A_PACKET, A_FRAME, A_PACKET, A_PACKET, A_FRAME, A_PACKET],
    ),
    **{
        f"checksum like a header, then a frame of {len(frame)} bytes": (
            LIKE_A_HEADER + frame,
            [item(ServoPacket, data=LIKE_A_HEADER), item(Frame, data=frame)],
        )
        for frame in (FRAME, ANGLES)
    },
    "servo packet around two frames": (
        READ[:5] + FRAME * 2 + READ[5:],
        [
            servo(spans=((0, READ[:5]), (17, READ[5:]))),
            item(Frame, offset=5),
            item(Frame, offset=11),
        ],
    ),
    "cmd_len error, five times": (ERROR * 5, [AN_ERROR] * 5),
    "cmd_len error with another line end": (b"cmd_len error\n" * 5, [AN_ERROR] * 5),
    "cmd_len error without a line end": (b"cmd_len error" * 5, [AN_ERROR] * 5),
    "cmd_len error around a frame": (ERROR + FRAME + ERROR, [AN_ERROR, A_FRAME, AN_ERROR]),
    "panic": (
        noise.PANIC,
        [item(Panic, **A_CAUSE, rebooting=True, pc=0x400D15F4, address=4, backtrace=BACKTRACE)],
    ),
    "short panic": (
        b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited)...",
        [item(Panic, **A_CAUSE, rebooting=False)],
    ),
    "panic of older firmware": (OLD_PANIC, [item(Panic, core=0, cause="StoreProhibited")]),
    "two panics without a reboot": (
        noise.PANIC[:150] + noise.PANIC,
        [item(Panic, data=noise.PANIC[:150]), item(Panic, data=noise.PANIC)],
    ),
    **{
        f"{count} NULs": (bytes(count), [item(Nuls, count=count, reboot=count > 63)])
        for count in (1, 17, 63, 277)
    },
    "lines of text around a frame": (
        b"ets Jul 29 2019\r\nok\r\nload:0x3fff" + FRAME + b"0030,len:4\r\n",
        [
            item(Text, text="ets Jul 29 2019\r\n"),
            item(Text, text="ok\r\n"),
            item(Text, text="load:0x3fff0030,len:4\r\n"),
            A_FRAME,
        ],
    ),
    **{f"log, {line!r}": (line, [item(Text, text=line.decode())]) for line in noise.LOG},
    # This edition lists no acknowledgement of power_on.
    "frames directly after each other": (
        bytes.fromhex("FE FE 03 10 01 FA") + ANGLES,
        [
            item(UnlistedFrame, id=0x10, command="power_on"),
            item(Frame, offset=6, data=ANGLES, command=0x20),
        ],
    ),
    "unknown id": (
        bytes.fromhex("FE FE 04 E0 01 02 FA"),
        [item(UnlistedFrame, id=0xE0, command=None)],
    ),
    "request among replies": (REQUEST, [opposite("request")]),
    "wrong baud rate": (
        bytes.fromhex("78 80 78"),
        [item(Garbage, fitting=3, chance=pytest.approx((28 / 256) ** 3))],
    ),
    "four bytes of nothing": (bytes.fromhex("02 38 02 be"), [(Unrecognised, {})]),
    "wrong footer": (
        ANGLES[:-1] + b"\xfb" + FRAME,
        [damaged("get_angles", "bad-check", data=ANGLES[:-1] + b"\xfb"), A_FRAME],
    ),
    "lost byte": (
        ANGLES[:11] + ANGLES[12:] + FRAME,
        [damaged("get_angles", "bad-check", data=ANGLES[:11] + ANGLES[12:]), A_FRAME],
    ),
    "one byte too many": (
        ANGLES[:13] + ANGLES[12:] + FRAME,
        [damaged("get_angles", "bad-check", data=ANGLES[:13] + ANGLES[12:]), A_FRAME],
    ),
    "wrong LEN": (
        b"\xfe\xfe\x0d" + ANGLES[3:] + FRAME,
        [damaged("get_angles", "bad-length", data=b"\xfe\xfe\x0d" + ANGLES[3:]), A_FRAME],
    ),
    "truncated frame": (ANGLES[:9], [damaged("get_angles", "truncated")]),
    "start of a frame": (ANGLES[:3], [damaged(None, "truncated")]),
    "truncated frame before other noise": (
        ANGLES[:9] + ERROR + READ,
        [item(DamagedFrame), AN_ERROR, A_PACKET],
    ),
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_is_recognised(codec: Codec, name: str) -> None:
    data, expected = EXAMPLES[name]
    items = diagnose(codec, data)
    assert kinds(items) == [kind for kind, _ in expected]
    for item, (_, attributes) in zip(items, expected):
        assert {key: getattr(item, key) for key in attributes} == attributes


def test_opposite_frame_is_an_echo_if_it_was_sent(codec: Codec) -> None:
    for items, (kind, attributes) in (
        (diagnose(codec, REQUEST, sent=REQUEST), opposite("request", sent=True)),
        (diagnose(codec, ANGLES, listening="request"), opposite("reply")),
    ):
        assert kinds(items) == [kind]
        assert {key: getattr(items[0], key) for key in attributes} == attributes
    assert "perhaps " in only(codec, bytes.fromhex("78 80 78")).describe()  # type: ignore[union-attr]
