"""The base classes of faults: their conditions, and what they do to requests and replies."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields
from random import Random
from typing import ClassVar, Literal

from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import FrameFormat, Table
from cobotwire.simulator.faults.exchange import Reply, Request, joined, recut
from cobotwire.simulator.faults.faulty_connection import FaultyConnection
from cobotwire.simulator.faults.rules import (
    LONGEST_SECONDS,
    RULE,
    SECONDS,
    SHARE,
    Several,
    command,
    integer,
    one_of,
    optional,
    ruled,
)

Only = Literal["requests", "replies", "acknowledgements", "malformed input"]
ONLY = ("requests", "replies", "acknowledgements", "malformed input")
"""Any legal request; a request that needs a reply; one that is acknowledged; anything else."""

COUNT = integer(1, 1_000_000)


@dataclass(slots=True)
class Context:
    """A request to which a fault is applied, and what the fault may use.

    Attributes:
        request: what was received.
        random: the source of random numbers, repeatable by the seed.
        connection: the state that outlasts the request.
        table: the edition.
        number: the number of the request, if its reply is reported when it has been sent.
        delay: the delay of the reply, in seconds.
    """

    request: Request
    random: Random
    connection: FaultyConnection
    table: Table
    number: int | None = None
    delay: float = 0.0
    _details: list[str] = field(default_factory=list)
    _moved: int = 0

    @property
    def frame(self) -> FrameFormat:
        """How the edition builds frames."""
        return self.table.frame

    def report(self, detail: str) -> None:
        """Report what the fault did."""
        self._details.append(detail)

    def put_later(self, seconds: float, reply: Reply) -> None:
        """Send another reply after ``seconds``."""
        self._moved += len(joined(reply))
        self.connection.put(reply, seconds)

    def hold(self, seconds: float, reply: Reply) -> bool:
        """Hold a reply back until the next one.

        Return False if one is held already: it is sent with this one.
        """
        if self.connection.outlet.holds:
            return False
        self._moved += len(joined(reply))
        self.connection.hold(seconds, reply, self.number)
        return True

    def drop_unsent(self) -> int:
        """Discard all unsent replies; return their number of bytes."""
        lost = self.connection.outlet.drop()
        self._moved -= lost
        return lost

    def take_report(self) -> tuple[str, int]:
        """Return what was reported since the last call, and how many bytes were moved."""
        report = "; ".join(self._details), self._moved
        self._details, self._moved = [], 0
        return report


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """Something that goes wrong.

    The fields are the keys of a scenario file. A request must meet all conditions that are given.

    Attributes:
        commands: only these commands, by name or by id; empty: any command.
        only: only this kind of request; see ``ONLY``.
        nth: only these, by their numbers among the requests that meet ``commands`` and ``only``,
            counted from 1; empty: each.
        every: only every n-th of these requests.
        first: with ``every``: the number of the first one; None: the same as ``every``.
        probability: 0 never, 1 always.
        from_seconds: not before this time, counted from the beginning of the scenario.
        until_seconds: not at this time or later.

    Raises:
        UsageError: a field has a value that is not allowed.
    """

    kind: ClassVar[str] = ""
    # Whether the fault does something only where there is a reply.
    wants_reply: ClassVar[bool] = True
    # Whether the fault is also applied to the rest of malformed input, or of a request's text.
    continues: ClassVar[bool] = False

    commands: tuple[str | int, ...] = ruled(Several(command), ())
    only: Only = ruled(one_of(ONLY), "requests")
    nth: tuple[int, ...] = ruled(Several(COUNT), ())
    every: int = ruled(COUNT, 1)
    first: int | None = ruled(optional(COUNT), None)
    probability: float = ruled(SHARE, 1.0)
    from_seconds: float = ruled(SECONDS, 0.0)
    until_seconds: float | None = ruled(optional(SECONDS), None)

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            try:
                kept = one.metadata[RULE](value)
            except ValueError as error:
                raise UsageError(f"{self.kind}.{one.name}", value, str(error)) from None
            object.__setattr__(self, one.name, kept)
        if self.until_seconds is not None and self.until_seconds <= self.from_seconds:
            allowed = f"more than from_seconds, {self.from_seconds:g}, up to {LONGEST_SECONDS:g}"
            raise UsageError(f"{self.kind}.until_seconds", self.until_seconds, allowed)

    def change_request(self, data: bytes, context: Context) -> bytes:
        """Return what the arm receives of a request."""
        return data

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Return what the host receives of a reply."""
        return reply


@dataclass(frozen=True, slots=True, kw_only=True)
class Damage(Fault, ABC):
    """A fault that changes the bytes of the reply, or of the request.

    Attributes:
        of: which of the two.
    """

    of: Literal["reply", "request"] = ruled(one_of(("reply", "request")), "reply")

    @abstractmethod
    def spoil(self, data: bytes, context: Context) -> bytes:
        """Return the damaged bytes; there is at least one byte to damage."""

    def change_request(self, data: bytes, context: Context) -> bytes:
        """Damage the request, if the fault is one of requests."""
        return self.spoil(data, context) if self.of == "request" else data

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Damage the reply, if the fault is one of replies."""
        if self.of == "request":
            return reply
        return recut(reply, self.spoil(joined(reply), context))
