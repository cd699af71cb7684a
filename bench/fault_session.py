"""A session of calls that our client and pymycobot both know, and the arm that answers it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.session import Asked, DeviceSession
from field_notes.case import ACK, DONE, GET_ANGLES, READ, Call, encoder
from field_notes.play import OPENERS, Outcome, called

POWERED = Call("is_power_on", (), 1)
# 27.5 mm are 0x0113: an XOFF stands in the reply.
COORDS = Call("get_coords", (), [27.5, -60.2, 250.0, -90.5, 1.25, -86.0])
REGISTER = Call("get_servo_data", (1, 24, 1), 1000)
# An order's own bytes: it is right if they came to the arm, and as often as it was called.
ORDERS = (
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
ON, COLOUR, MOVE, OUTPUT = ORDERS
SESSION = (
    *(ON, POWERED, GET_ANGLES, COLOUR, GET_ANGLES, encoder(1), encoder(2), MOVE, GET_ANGLES),
    *(COORDS, encoder(3), OUTPUT, GET_ANGLES, REGISTER, encoder(4), GET_ANGLES, POWERED, COORDS),
)


# Our client, told to wait for the acknowledgement of each order.
CAREFUL = "careful"


class TimedOutcome(NamedTuple):
    """How a call of the session ended, and in how many seconds."""

    outcome: Outcome
    seconds: float


def play_session(who: str, url: str) -> list[TimedOutcome]:
    """All calls, by one library; opening is not timed."""
    careful = who == CAREFUL
    arm = OPENERS["blocking" if careful else who](url)
    timed = []
    for call in SESSION:
        if careful and call.right == DONE:
            call = replace(call, their_options={"ack_within": 0.5})
        started = time.monotonic()
        outcome = called(call, arm, careful or who == "pymycobot")
        timed.append(TimedOutcome(outcome, time.monotonic() - started))
    return timed


class SteadyArm:
    """Answers what the session asks, always the same; a restart changes nothing that it asks for.

    So whatever is read otherwise is the line's doing.
    """

    wait = None

    def __init__(self) -> None:
        self.frames: list[bytes] = []
        self._session = DeviceSession(codecs.load(TABLE))

    def receive(self, data: bytes) -> bytes:
        """Answer each request."""
        said = b""
        for event in self._session.receive(data):
            if isinstance(event, Asked):
                self.frames.append(event.frame.data)
                said += self._answer(event)
        return said

    def flush(self) -> bytes:
        """Nothing is said later."""
        return b""

    def _answer(self, asked: Asked) -> bytes:
        command, fields = asked.message.command, asked.message.fields
        if command.name in ANSWERS:
            values = ANSWERS[command.name](fields)
            form = next(form for form in command.reply if len(form.fields) == len(values))
            named = dict(zip((field.name for field in form.fields), values))
            return self._session.answer(command.name, named)
        return ACK.replace(b"\x10", bytes([command.id])) if command.ack else b""


ANSWERS: dict[str, Callable[[dict[str, Any]], list[Any]]] = {
    "get_angles": lambda asked: [READ],
    "get_coords": lambda asked: [COORDS.right],
    "is_power_on": lambda asked: [True],
    "get_encoder": lambda asked: [1000 + asked["joint"]],
    "get_servo_data": lambda asked: [REGISTER.right],
}
