"""What a fault is: when it is done, and what it does to a request and to the reply."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from random import Random
from typing import ClassVar, Literal

from cobotwire.errors import UsageError
from cobotwire.sim.faults.exchange import Reply, Request, joined, recut
from cobotwire.sim.faults.line import Line
from cobotwire.sim.faults.rules import (
    LONGEST_SECONDS,
    RULE,
    SECONDS,
    SHARE,
    Several,
    command,
    one_of,
    optional,
    ruled,
    whole,
)
from cobotwire.table import FrameFormat

Only = Literal["requests", "answers", "acknowledgements", "malformed input"]
ONLY = ("requests", "answers", "acknowledgements", "malformed input")
"""Any legal request; those that an answer is due to; those that are acknowledged; anything else."""

COUNT = whole(1, 1_000_000)


class Moment:
    """A request at which a fault is done, and what the fault may use.

    Attributes:
        request: what was heard.
        random: draws, the same ones for the same seed.
        line: what the fault may do beside changing request and reply.
        delay: seconds by which the reply comes later.
        frame: how frames are built in this edition.
    """

    def __init__(self, request: Request, random: Random, line: Line, frame: FrameFormat) -> None:
        self.request = request
        self.random = random
        self.line = line
        self.frame = frame
        self.delay = 0.0
        self._details: list[str] = []
        self._moved = 0

    def did(self, detail: str) -> None:
        """Note what was done."""
        self._details.append(detail)

    def put_later(self, seconds: float, reply: Reply) -> None:
        """Say something by itself, so much later."""
        self._moved += len(joined(reply))
        self.line.put(reply, seconds)

    def hold(self, seconds: float, reply: Reply) -> bool:
        """Keep a reply for the next one; False: another is kept already, and goes with this."""
        if self.line.outlet.holds:
            return False
        self._moved += len(joined(reply))
        self.line.hold(seconds, reply)
        return True

    def drop_unsaid(self) -> int:
        """What was still to be said is lost; gives how many bytes that were."""
        lost = self.line.outlet.drop()
        self._moved -= lost
        return lost

    def told(self) -> tuple[str, int]:
        """What was noted since this was last asked, and how many bytes went beside the reply."""
        told = "; ".join(self._details), self._moved
        self._details, self._moved = [], 0
        return told


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """Something that goes wrong.

    The fields are the keys of a scenario file. All that are given must hold for a request.

    Attributes:
        commands: at these, by name, or by id; empty: at any.
        only: at what kind of request; see ``ONLY``.
        nth: at the first, second ... of them, counted from 1; empty: at each.
        every: 2: at every second of them; 3: at every third.
        probability: 0 never, 1 always.
        from_seconds: not before, counted from the beginning of the scenario.
        until_seconds: not then or later.

    Raises:
        UsageError: a field holds what it may not.
    """

    kind: ClassVar[str] = ""
    # Whether there is something to do only where something is answered.
    wants_reply: ClassVar[bool] = True
    # Whether it is done to all of malformed input, and of a text, however it comes in pieces.
    goes_on: ClassVar[bool] = False

    commands: tuple[str | int, ...] = ruled(Several(command), ())
    only: Only = ruled(one_of(ONLY), "requests")
    nth: tuple[int, ...] = ruled(Several(COUNT), ())
    every: int = ruled(COUNT, 1)
    probability: float = ruled(SHARE, 1.0)
    from_seconds: float = ruled(SECONDS, 0.0)
    until_seconds: float | None = ruled(optional(SECONDS), None)

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            try:
                kept = field.metadata[RULE](value)
            except ValueError as error:
                raise UsageError(f"{self.kind}.{field.name}", value, str(error)) from None
            object.__setattr__(self, field.name, kept)
        if self.until_seconds is not None and self.until_seconds <= self.from_seconds:
            allowed = f"more than from_seconds, {self.from_seconds:g}, up to {LONGEST_SECONDS:g}"
            raise UsageError(f"{self.kind}.until_seconds", self.until_seconds, allowed)

    def hear(self, data: bytes, moment: Moment) -> bytes:
        """What the arm hears of a request."""
        return data

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """What the host hears of a reply."""
        return reply


@dataclass(frozen=True, slots=True, kw_only=True)
class Damage(Fault, ABC):
    """A fault that changes bytes: those of the reply, or those of the request on its way.

    Attributes:
        of: which of the two.
    """

    of: Literal["reply", "request"] = ruled(one_of(("reply", "request")), "reply")

    @abstractmethod
    def spoil(self, data: bytes, moment: Moment) -> bytes:
        """What becomes of the bytes, of which there is at least one."""

    def hear(self, data: bytes, moment: Moment) -> bytes:
        """Spoil the request, if that is what is spoilt."""
        return self.spoil(data, moment) if self.of == "request" else data

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """Spoil the reply, if that is what is spoilt."""
        if self.of == "request":
            return reply
        return recut(reply, self.spoil(joined(reply), moment))
