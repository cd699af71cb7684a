"""Faults that lose nothing, but say more than the arm did."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Literal

from cobotwire.sim.faults.exchange import Piece, Reply, enlarged, joined
from cobotwire.sim.faults.fault import ONLY, Damage, Fault, Moment, Only
from cobotwire.sim.faults.noise import COMMAND_ERROR, LEAKS
from cobotwire.sim.faults.registry import kind
from cobotwire.sim.faults.rules import (
    SECONDS,
    Several,
    one_of,
    optional,
    pairs_of_hex,
    ruled,
    whole,
)

Where = Literal["in front", "inside", "behind"]
TIMES = whole(1, 1000)


@dataclass(frozen=True, slots=True, kw_only=True)
class Addition(Damage):
    """Bytes that come in addition.

    Attributes:
        where: in front of the reply, behind it, or inside, which breaks it.
        after_bytes: inside: behind so many; left out: at random.
        times: how often, one right behind the other.
    """

    where: Where = ruled(one_of(("in front", "inside", "behind")), "in front")
    after_bytes: int | None = ruled(optional(whole(1, 4096)), None)
    times: int = ruled(TIMES, 1)

    @abstractmethod
    def drawn(self, moment: Moment) -> bytes:
        """The bytes to add, once."""

    def spoil(self, data: bytes, moment: Moment) -> bytes:
        """Put them in their place; what is too short to hold them inside has them behind."""
        cut, added = self._addition(len(data), moment)
        return data[:cut] + added + data[cut:]

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """The same, and the pauses stay where they were."""
        if self.of == "request":
            return reply
        return enlarged(reply, *self._addition(len(joined(reply)), moment))

    def _addition(self, size: int, moment: Moment) -> tuple[int, bytes]:
        """Where, in so many bytes, and what."""
        added = b"".join(self.drawn(moment) for _ in range(self.times))
        cut = {"in front": 0, "behind": size}.get(self.where, self.after_bytes or 0)
        if self.where == "inside" and not cut and size > 1:
            cut = moment.random.randrange(1, size)
        shown = added.hex(" ").upper() if len(added) <= 32 else f"{len(added)} bytes"
        moment.did(f"{shown} {self.where} of the {self.of}")
        return min(cut, size), added


@kind("inserted")
@dataclass(frozen=True, slots=True, kw_only=True)
class Inserted(Addition):
    """Any bytes: another command's frame, NULs, another program's request.

    Attributes:
        data: which.
    """

    data: bytes = ruled(pairs_of_hex, b"\x00")

    def drawn(self, moment: Moment) -> bytes:
        """The bytes as they are."""
        return self.data


@kind("servo-leak")
@dataclass(frozen=True, slots=True, kw_only=True)
class ServoLeak(Addition):
    """Packets of the servo bus come through.

    Attributes:
        packets: which; of Several, one at random each time.
    """

    packets: tuple[str, ...] = ruled(Several(one_of(LEAKS)), tuple(LEAKS))

    def drawn(self, moment: Moment) -> bytes:
        """One of the packets."""
        return LEAKS[moment.random.choice(self.packets)]


@kind("command-error")
@dataclass(frozen=True, slots=True, kw_only=True)
class CommandError(Fault):
    """The firmware says ``cmd_len error``: to malformed input, unless told otherwise.

    Attributes:
        times: how often.
        seconds: between one and the next, and before the reply, which comes behind them.
    """

    wants_reply = False

    only: Only = ruled(one_of(ONLY), "malformed input")
    times: int = ruled(TIMES, 1)
    seconds: float = ruled(SECONDS, 0.0)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """The text in front of the reply, if there is one."""
        moment.did(f"{COMMAND_ERROR.decode().strip()}, {self.times} times")
        texts = tuple(Piece(self.seconds if n else 0.0, COMMAND_ERROR) for n in range(self.times))
        return _behind(texts, self.seconds, reply)


@kind("doubled")
@dataclass(frozen=True, slots=True, kw_only=True)
class Doubled(Fault):
    """The reply comes again.

    Attributes:
        seconds: how much later; 0: in one piece with itself. Others may come in between.
    """

    seconds: float = ruled(SECONDS, 0.0)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """Say it twice."""
        moment.did(f"again after {self.seconds:g} s")
        if self.seconds:
            moment.put_later(self.seconds, reply)
            return reply
        return (*reply[:-1], Piece(reply[-1].pause, reply[-1].data + joined(reply)))


@kind("echo")
@dataclass(frozen=True, slots=True, kw_only=True)
class Echo(Fault):
    """The host's own bytes come back, in front of the reply.

    Attributes:
        seconds: between the echo and the reply.
    """

    wants_reply = False
    goes_on = True

    seconds: float = ruled(SECONDS, 0.0)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """The request, then the reply."""
        moment.did(f"{len(moment.request.data)} bytes of the host come back")
        return _behind((Piece(0.0, moment.request.data),), self.seconds, reply)


def _behind(first: Reply, pause: float, reply: Reply) -> Reply:
    """A reply behind something else; in one piece with it where there is no pause."""
    if reply and not pause + reply[0].pause:
        glued = Piece(first[-1].pause, first[-1].data + reply[0].data)
        return (*first[:-1], glued, *reply[1:])
    return (*first, *(Piece(pause + p.pause if p is reply[0] else p.pause, p.data) for p in reply))
