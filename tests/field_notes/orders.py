"""Cases of orders, of lines that break, and of several that share a line."""

from __future__ import annotations

from field_notes.case import ANGLES, DONE, NO_ANSWER, Call, Case, Script, encoder, encoder_reply

STEP = Call("jog_increment", (1, 5, 50), DONE, bytes.fromhex("FE FE 06 33 01 01 F4 32 FA"))
ROUNDED = Call("send_angle", (1, 0.29, 50), DONE, bytes.fromhex("FE FE 06 21 01 00 1D 32 FA"))
CONTROLS = Call("set_color", (0x13, 0x11, 0x13), DONE, bytes.fromhex("FE FE 05 6A 13 11 13 FA"))
FILLING = Call("send_angle", (1, 10, 50), DONE, their_options={"_async": True})
NEVER = Call("get_angles", (), NO_ANSWER)


def _acknowledged(request: bytes, number: int) -> Script:
    return (0.005, b"\xfe\xfe\x03" + request[3:4] + b"\x01\xfa")


def _encoders(request: bytes, number: int) -> Script:
    if request[3] == 0x3B and len(request) == 6:
        return (0.01, encoder_reply(request[4]))
    return (b"cmd_len error\r\n",)


CASES = (
    Case(
        "a relative move that nothing answers", ("unanswered",), "silence", (), (STEP,), within=0.5
    ),
    Case(
        "a relative move that firmware text answers",
        ("unanswered", "text"),
        "`cmd_len error` to each request",
        ((b"cmd_len error\r\n",),),
        (STEP,),
        within=0.5,
    ),
    Case(
        "0.29 degrees",
        ("truncated",),
        "acknowledges; 0.29 x 100 is 29",
        _acknowledged,
        (ROUNDED,),
        within=0.5,
    ),
    Case(
        "XON and XOFF in an order",
        ("xon",),
        "the port is left in its default mode; 13 11 13",
        _acknowledged,
        (CONTROLS,),
        cooked=True,
        within=0.5,
    ),
    Case(
        "the port goes while a reply comes",
        ("vanished",),
        "5 bytes of the reply, 100 ms, then the line is closed",
        ((ANGLES[:5], 0.1, None),),
        (NEVER, NEVER),
        ours=("LinkError", "LinkError"),
        within=0.6,
    ),
    Case(
        "two threads on one arm",
        ("two writers",),
        "each of 4 threads asks for its joint 10 times; each request is answered 10 ms later",
        _encoders,
        tuple(encoder(joint) for joint in (1, 2, 3, 4)),
        ours=("right",) * 40,
        asked=40,
        threads=True,
        repeat=10,
        within=4.0,
    ),
    Case(
        "two programs on one port",
        ("two writers",),
        "each of 2 programs asks for its joint 20 times; each request is answered 10 ms later",
        _encoders,
        (encoder(1), encoder(2)),
        ours=("right",) * 20 + ("LinkError",),
        asked=20,
        clients=2,
        repeat=20,
        links=("pty",),
        within=4.0,
    ),
    Case(
        "a line that takes no bytes",
        ("vanished",),
        "nobody reads; an order is sent again and again (pymycobot: with `_async=True`)",
        (),
        (FILLING,),
        ours=("LinkError",),
        asked=0,
        deaf=True,
        repeat=5000,
        links=("pty",),
        within=8.0,
    ),
)
