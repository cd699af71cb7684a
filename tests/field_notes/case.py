"""What a case is made of, and the frames that many of them share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

Step = bytes | float | None
Script = tuple[Step, ...]
Answer = Callable[[bytes, int], Script]

DONE = "done"
"""What an order gives: it is judged by what the peer heard."""

NO_ANSWER = "no answer"
"""Nothing that the peer sends is an answer: an error is all that is right."""

ANGLES = bytes.fromhex("FE FE 0E 20 00 8C 00 3D FF E6 FF 3F 00 AF FF 51 FA")
READ = [1.4, 0.61, -0.26, -1.93, 1.75, -1.75]
ASK = bytes.fromhex("FE FE 02 20 FA")
POWERED = bytes.fromhex("FE FE 03 12 01 FA")
ACK = bytes.fromhex("FE FE 03 10 01 FA")
PAUSE_OF_FIRMWARE = 0.02


@dataclass(frozen=True)
class Call:
    """One call, of the same name and arguments in every library.

    Attributes:
        right: the value that the arm's answer means; or DONE, or NO_ANSWER.
        sends: for orders: the one frame that must be on the line, once.
        their_options: what pymycobot wants in addition, for the same frame.
    """

    method: str
    arguments: tuple[Any, ...] = ()
    right: Any = None
    sends: bytes = b""
    their_options: Mapping[str, Any] = field(default_factory=dict)


GET_ANGLES = Call("get_angles", (), READ)


def encoder(joint: int) -> Call:
    """A question whose answer names nothing: only its value tells whose it is."""
    return Call("get_encoder", (joint,), 1000 + joint)


def encoder_reply(joint: int) -> bytes:
    """The answer to it."""
    return bytes.fromhex("FE FE 04 3B") + (1000 + joint).to_bytes(2, "big") + b"\xfa"


@dataclass(frozen=True)
class Case:
    """A peer that does one thing of the notes, and what is called meanwhile.

    Attributes:
        name: as it stands in the table.
        notes: which lines it stands for, see ``notes.py``.
        peer: what it does, in the words of the table.
        answers: what it plays to the first request, the second and so on, the last again and again;
            or a function of the request and its number.
        calls: what is called, in turn.
        ours: how each call ends for our clients: ``right``, or the name of the error.
        asked: how many frames our clients send; None where chance has a part in it.
        within: seconds that our clients may take for all of it.
    """

    name: str
    notes: tuple[str, ...]
    peer: str
    answers: tuple[Script, ...] | Answer = ()
    calls: tuple[Call, ...] = (GET_ANGLES,)
    ours: tuple[str, ...] = ("right",)
    asked: int | None = 1
    within: float = 1.0
    links: tuple[str, ...] = ("pty", "tcp")
    repeat: int = 1
    threads: bool = False
    clients: int = 1
    deaf: bool = False
    cooked: bool = False

    def answer(self, request: bytes, number: int) -> Script:
        """What the peer plays to this request; ``number`` counts from 0."""
        if callable(self.answers):
            return self.answers(request, number)
        if not self.answers:
            return ()
        return self.answers[min(number, len(self.answers) - 1)]
