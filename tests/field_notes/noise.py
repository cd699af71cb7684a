"""Cases of bytes that are nobody's answer: servo packets, firmware text, NULs, echoes, garbage."""

from __future__ import annotations

from field_notes.case import ANGLES, DONE, GET_ANGLES, NO_ANSWER, Call, Case, Script


def servo_packet(body: str) -> bytes:
    """A Feetech packet with its checksum: the complement of the sum behind FF FF."""
    data = bytes.fromhex(body)
    return b"\xff\xff" + data + bytes([~sum(data) & 0xFF])


LEAKS = {
    "a servo read": bytes.fromhex("FF FF 01 04 02 38 02 BE"),
    "a servo's reply": bytes.fromhex("FF FF 01 04 00 FF 07 F4"),
    "a sync read": bytes.fromhex("FF FF FE 0A 82 38 0F 01 02 03 04 05 06 19"),
    "a sync write": servo_packet("FE 0C 83 29 07 06 08 00 00 00 00 F4 01"),
    "a servo ping": bytes.fromhex("FF FF 07 02 01 F5"),
}
# ID 1, LEN 4, READ, register 0x38, 0xC2 bytes: their sum is 0x101, the checksum FE.
CHECKSUM_FE = servo_packet("01 04 02 38 C2")
PANIC = (
    b"Guru Meditation Error: Core 1 panic'ed (LoadProhibited). Exception was unhandled.\r\n"
    + b"Core 1 register dump:\r\n"
    + b"PC      : 0x400d1a2b  PS      : 0x00060830  A0      : 0x800d2c3d\r\n" * 34
    + b"Backtrace:0x400d1a2b:0x3ffb1f60 0x400d2c3a:0x3ffb1f80\r\n\r\nRebooting...\r\n"
)
OTHER_BAUD = bytes.fromhex("78 80 78 F8 00 E6 1E 98 06 7E 80 FE 66 86 18 FF")
TEXT = b"cmd_len error\r\n"


def _echo(request: bytes, number: int) -> Script:
    return (request, 0.005, ANGLES)


def _output_echo(request: bytes, number: int) -> Script:
    return (request,) if request[3] == 0xA0 else (ANGLES,)


CASES = (
    *(
        Case(
            f"{name} in front", ("leak", "leak packets"), leak.hex(" ").upper(), ((leak + ANGLES,),)
        )
        for name, leak in LEAKS.items()
    ),
    Case(
        "a servo's checksum of FE in front",
        ("leak FE",),
        f"{CHECKSUM_FE.hex(' ').upper()}, so that FE FE FE 0E is read",
        ((CHECKSUM_FE + ANGLES,),),
    ),
    Case(
        "a servo packet inside the reply",
        ("leak",),
        "the first reply is cut in two by a ping; the second is whole",
        ((ANGLES[:9] + LEAKS["a servo ping"] + ANGLES[9:],), (ANGLES,)),
        asked=2,
    ),
    Case("firmware text in front", ("text",), "`cmd_len error`, once", ((TEXT + ANGLES,),)),
    Case(
        "firmware text, again and again",
        ("text",),
        "`cmd_len error` 20 times, 5 ms between them, then the reply",
        ((*(TEXT, 0.005) * 20, ANGLES),),
        asked=None,
    ),
    Case("a panic in front", ("panic",), f"{len(PANIC)} bytes of panic", ((PANIC, ANGLES),)),
    Case(
        "a panic inside the reply",
        ("panic", "boot"),
        "9 bytes of the reply, panic, 277 NULs, garbage; the next reply is whole",
        ((ANGLES[:9] + PANIC + bytes(277) + OTHER_BAUD,), (ANGLES,)),
        asked=2,
    ),
    Case("277 NULs in front", ("boot",), "277 NULs, then the reply", ((bytes(277) + ANGLES,),)),
    Case(
        "boot output at another baud rate",
        ("boot",),
        OTHER_BAUD.hex(" ").upper() + ", then the reply",
        ((OTHER_BAUD + ANGLES,),),
    ),
    Case(
        "wrong baud rate",
        ("baud",),
        "78 80 78 is all that ever comes",
        ((b"\x78\x80\x78",),),
        (Call("get_angles", (), NO_ANSWER),),
        ours=("ReplyTimeout",),
        asked=3,
    ),
    Case(
        "our own bytes come back",
        ("echo",),
        "each request is echoed, the reply follows 5 ms later",
        _echo,
    ),
    Case(
        "an order's bytes come back",
        ("echo",),
        "the transponder echoes set_basic_output (0xA0); then get_angles is asked",
        _output_echo,
        (
            Call("set_basic_output", (2, 1), DONE, bytes.fromhex("FE FE 04 A0 02 01 FA")),
            GET_ANGLES,
        ),
        ours=("right", "right"),
        asked=2,
    ),
)
