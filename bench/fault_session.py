"""A session of calls that our client and pymycobot both have."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import NamedTuple

from field_notes.case import DONE, GET_ANGLES, Call, encoder
from field_notes.line import COORDS_READ, REGISTER_READ
from field_notes.play import OPENERS, Outcome, called

POWERED = Call("is_power_on", (), 1)
COORDS = Call("get_coords", (), COORDS_READ)
REGISTER = Call("get_servo_data", (1, 24, 1), REGISTER_READ)
# Setters return nothing; a call is right if its bytes arrive exactly once.
ONE_WAY = (
    Call("power_on", (), DONE, bytes.fromhex("FE FE 02 10 FA")),
    Call("set_color", (1, 2, 3), DONE, bytes.fromhex("FE FE 05 6A 01 02 03 FA")),
    Call(
        "send_angles",
        ([10, 20, 30, 40, 50, 60], 50),
        DONE,
        bytes.fromhex("FE FE 0F 22 03 E8 07 D0 0B B8 0F A0 13 88 17 70 32 FA"),
    ),
    Call("set_basic_output", (2, 1), DONE, bytes.fromhex("FE FE 04 A0 02 01 FA")),
)
ON, COLOUR, MOVE, OUTPUT = ONE_WAY
SESSION = (
    *(ON, POWERED, GET_ANGLES, COLOUR, GET_ANGLES, encoder(1), encoder(2), MOVE, GET_ANGLES),
    *(COORDS, encoder(3), OUTPUT, GET_ANGLES, REGISTER, encoder(4), GET_ANGLES, POWERED, COORDS),
)


# Our client, when it waits for the acknowledgement of each setter.
CAREFUL = "careful"


class TimedOutcome(NamedTuple):
    """How a call of the session ended, and in how many seconds."""

    outcome: Outcome
    seconds: float


def play_session(who: str, url: str) -> list[TimedOutcome]:
    """Make all calls with one library; the time does not include opening."""
    careful = who == CAREFUL
    arm = OPENERS["blocking" if careful else who](url)
    timed = []
    for call in SESSION:
        if careful and call.right == DONE:
            call = replace(call, pymycobot_options={"ack_within": 0.5})
        started = time.monotonic()
        outcome = called(call, arm, careful or who == "pymycobot")
        timed.append(TimedOutcome(outcome, time.monotonic() - started))
    return timed
