"""Cases of bytes that are nobody's answer: servo packets, firmware text, NULs, echoes, garbage."""

from __future__ import annotations

from cobotwire.sim.faults import noise
from field_notes.case import ANGLES, DONE, GET_ANGLES, NO_ANSWER, Call, Case, Script

LEAKS = {
    "a servo read": noise.LEAKS["read"],
    "a servo's reply": noise.LEAKS["status"],
    "a sync read": noise.LEAKS["sync read"],
    "a sync write": noise.LEAKS["sync write"],
    "a servo ping": noise.LEAKS["ping"],
}
CHECKSUM_FE = noise.LEAKS["checksum FE"]
PANIC = noise.PANIC
OTHER_BAUD = noise.at_other_rate(noise.BOOT, 4)[:16]
TEXT = noise.COMMAND_ERROR


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
