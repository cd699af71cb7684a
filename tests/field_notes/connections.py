"""Cases of one-way requests, of lines that break, and of clients that share a line."""

from __future__ import annotations

from cobotwire.simulator.faults import CommandError, Fault, Late, Lost, Truncated, Unplugged
from field_notes.case import DONE, GET_NOTHING, Call, Case, encoder

STEP = Call("jog_increment", (1, 5, 50), DONE, bytes.fromhex("FE FE 06 33 01 01 F4 32 FA"))
ROUNDED = Call("send_angle", (1, 0.29, 50), DONE, bytes.fromhex("FE FE 06 21 01 00 1D 32 FA"))
CONTROLS = Call("set_color", (0x13, 0x11, 0x13), DONE, bytes.fromhex("FE FE 05 6A 13 11 13 FA"))
FILLING = Call("send_angle", (1, 10, 50), DONE, pymycobot_options={"_async": True})
ACKNOWLEDGED = (Late(seconds=0.005),)
# The firmware sends an error for malformed input, and replies after 10 ms.
SHARED: tuple[Fault, ...] = (Late(seconds=0.01), CommandError())

CASES = (
    Case(
        "a relative move that nothing answers",
        ("unanswered",),
        "silence",
        (Lost(),),
        (STEP,),
        within=0.5,
    ),
    Case(
        "a relative move that firmware text answers",
        ("unanswered", "text"),
        "`cmd_len error` to each request",
        (Lost(), CommandError(only="requests")),
        (STEP,),
        within=0.5,
    ),
    Case(
        "0.29 degrees",
        ("truncated",),
        "acknowledges; 0.29 x 100 is 29",
        ACKNOWLEDGED,
        (ROUNDED,),
        within=0.5,
    ),
    Case(
        "XON and XOFF in a request",
        ("xon",),
        "the port is left in its default mode; 13 11 13",
        ACKNOWLEDGED,
        (CONTROLS,),
        cooked=True,
        within=0.5,
    ),
    Case(
        "the port disappears during a reply",
        ("vanished",),
        "5 bytes of the reply, 100 ms, then the line is closed",
        (Truncated(after_bytes=5), Unplugged(seconds=0.1)),
        (GET_NOTHING, GET_NOTHING),
        verdicts=("LinkError", "LinkError"),
        within=0.6,
    ),
    Case(
        "two threads on one arm",
        ("two writers",),
        "each of 4 threads queries its joint 10 times; each reply takes 10 ms",
        SHARED,
        tuple(encoder(joint) for joint in (1, 2, 3, 4)),
        verdicts=("right",) * 40,
        requests=40,
        threads=True,
        repeat=10,
        within=4.0,
    ),
    Case(
        "two programs on one port",
        ("two writers",),
        "each of 2 programs queries its joint 20 times; each reply takes 10 ms",
        SHARED,
        (encoder(1), encoder(2)),
        verdicts=("right",) * 20 + ("LinkError",),
        requests=20,
        clients=2,
        repeat=20,
        transports=("pty",),
        within=4.0,
    ),
    Case(
        "a line that takes no bytes",
        ("vanished",),
        "nothing reads; a one-way request is sent again and again (pymycobot: `_async=True`)",
        (),
        (FILLING,),
        verdicts=("LinkError",),
        requests=0,
        unread=True,
        repeat=5000,
        transports=("pty",),
        within=8.0,
    ),
)
