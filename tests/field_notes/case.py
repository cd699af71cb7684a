"""The parts of a case, and the frames that many cases share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from cobotwire.simulator.faults import Fault

DONE = "done"
"""The result of a call that returns nothing; the frames at the arm decide whether it is right."""

NO_REPLY = "no reply"
"""The result of a call without a reply; only an error is right."""

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
ANGLES_READ = [1.4, 0.61, -0.26, -1.93, 1.75, -1.75]
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
ACK = bytes.fromhex("FE FE 03 10 01 FA")
FIRMWARE_PAUSE = 0.02


@dataclass(frozen=True)
class Call:
    """One call, with the same name and arguments in every library.

    Attributes:
        method: the name of the method.
        arguments: its arguments.
        right: the value in the arm's reply; or DONE, or NO_REPLY.
        sends: if ``right`` is DONE: the frame that must arrive exactly once.
        pymycobot_options: extra arguments, with which pymycobot sends the same frame.
    """

    method: str
    arguments: tuple[Any, ...] = ()
    right: Any = None
    sends: bytes = b""
    pymycobot_options: Mapping[str, Any] = field(default_factory=dict)


GET_ANGLES = Call("get_angles", (), ANGLES_READ)
GET_NOTHING = Call("get_angles", (), NO_REPLY)


def encoder(joint: int) -> Call:
    """Return a query; only the value in its reply identifies the joint."""
    return Call("get_encoder", (joint,), 1000 + joint)


def encoder_reply(joint: int) -> bytes:
    """Return the reply to ``encoder(joint)``."""
    return bytes.fromhex("FE FE 04 3B") + (1000 + joint).to_bytes(2, "big") + b"\xfa"


@dataclass(frozen=True)
class Case:
    """A serial line that behaves as the notes describe, and the calls that clients make on it.

    Attributes:
        name: the name in the table.
        notes: which pieces of the notes the case covers, see ``notes.py``.
        line: the behaviour of the line, as the table describes it.
        faults: what goes wrong between the client and the arm.
        calls: the calls, in order.
        verdicts: how each call ends for our clients: ``right``, or the name of the error.
        requests: how many frames our clients send; None where that depends on chance.
        within: how many seconds our clients may take for all calls.
        transports: on which transports the case runs.
        repeat: how many times the calls are made.
        threads: whether each call is made in a separate thread.
        clients: how many clients share the line.
        unread: whether nothing reads what the clients send.
        cooked: whether the port keeps its default mode, with XON/XOFF flow control.
    """

    name: str
    notes: tuple[str, ...]
    line: str
    faults: tuple[Fault, ...] = ()
    calls: tuple[Call, ...] = (GET_ANGLES,)
    verdicts: tuple[str, ...] = ("right",)
    requests: int | None = 1
    within: float = 1.0
    transports: tuple[str, ...] = ("pty", "tcp")
    repeat: int = 1
    threads: bool = False
    clients: int = 1
    unread: bool = False
    cooked: bool = False
