"""Cases of bytes that belong to no reply: servo packets, firmware text, NULs, echoes, garbage."""

from __future__ import annotations

from cobotwire.simulator.faults import (
    CommandError,
    Echo,
    Inserted,
    Lost,
    Panic,
    Replaced,
    ServoLeak,
)
from cobotwire.simulator.faults.noise import BOOT, LEAKS, PANIC, at_other_rate
from field_notes.case import DONE, GET_ANGLES, GET_NOTHING, Call, Case

PACKETS = {
    "a servo read": "read",
    "a servo's reply": "status",
    "a sync read": "sync read",
    "a sync write": "sync write",
    "a servo ping": "ping",
}
OTHER_BAUD = at_other_rate(BOOT, 4)[:16]


def _hex(data: bytes) -> str:
    return data.hex(" ").upper()


CASES = (
    *(
        Case(
            f"{name} before the reply",
            ("leak", "leak packets"),
            _hex(LEAKS[packet]),
            (ServoLeak(packets=(packet,)),),
        )
        for name, packet in PACKETS.items()
    ),
    Case(
        "a servo's checksum of FE before the reply",
        ("leak FE",),
        f"{_hex(LEAKS['checksum FE'])}, so that FE FE FE 0E is read",
        (ServoLeak(packets=("checksum FE",)),),
    ),
    Case(
        "a servo packet inside the reply",
        ("leak",),
        "the first reply is cut in two by a ping; the second is whole",
        (ServoLeak(packets=("ping",), where="inside", after_bytes=9, nth=(1,)),),
        requests=2,
    ),
    Case(
        "firmware text before the reply",
        ("text",),
        "`cmd_len error`, once",
        (CommandError(only="requests"),),
    ),
    Case(
        "firmware text, again and again",
        ("text",),
        "`cmd_len error` 20 times, 5 ms between them",
        (CommandError(only="requests", times=20, seconds=0.005),),
        requests=None,
    ),
    Case(
        "a panic before the reply",
        ("panic",),
        f"{len(PANIC)} bytes of panic",
        (Inserted(data=PANIC),),
    ),
    Case(
        "a panic inside the reply",
        ("panic", "boot"),
        "9 bytes of the reply, panic, 277 NULs, garbage; the next reply is whole",
        (Panic(nth=(1,), after_bytes=9, deaf_seconds=0),),
        requests=2,
    ),
    Case(
        "277 NULs before the reply",
        ("boot",),
        "as after a restart",
        (Inserted(data=b"\0", times=277),),
    ),
    Case(
        "boot output at another baud rate",
        ("boot",),
        _hex(OTHER_BAUD),
        (Inserted(data=OTHER_BAUD),),
    ),
    Case(
        "wrong baud rate",
        ("baud",),
        "78 80 78 is all that ever comes",
        (Replaced(by=b"\x78\x80\x78"),),
        (GET_NOTHING,),
        verdicts=("ReplyTimeout",),
        requests=3,
    ),
    Case(
        "our own bytes come back",
        ("echo",),
        "each request is echoed, the reply follows 5 ms later",
        (Echo(seconds=0.005),),
    ),
    Case(
        "a one-way request's bytes come back",
        ("echo",),
        "the transponder echoes set_basic_output (0xA0); then get_angles is called",
        (Lost(only="acknowledgements"), Echo(commands=(0xA0,))),
        (
            Call("set_basic_output", (2, 1), DONE, bytes.fromhex("FE FE 04 A0 02 01 FA")),
            GET_ANGLES,
        ),
        verdicts=("right", "right"),
        requests=2,
    ),
)
