"""Faults of time: every byte comes, but not when it should."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.sim.faults.exchange import Piece, Reply, joined, spread
from cobotwire.sim.faults.fault import Fault, Moment
from cobotwire.sim.faults.registry import kind
from cobotwire.sim.faults.rules import SECONDS, number, optional, ruled, whole


@kind("late")
@dataclass(frozen=True, slots=True, kw_only=True)
class Late(Fault):
    """The reply comes late; replies to later requests may overtake it.

    Attributes:
        seconds: how late.
        jitter_seconds: up to so much later still, at random.
    """

    seconds: float = ruled(SECONDS, 0.1)
    jitter_seconds: float = ruled(SECONDS, 0.0)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """The reply as it is, later."""
        seconds = self.seconds + moment.random.uniform(0, self.jitter_seconds)
        moment.did(f"{seconds:.3f} s late")
        moment.delay += seconds
        return reply


@kind("stalled")
@dataclass(frozen=True, slots=True, kw_only=True)
class Stalled(Fault):
    """The arm stalls: it hears, but says nothing until it is over, and then all in order.

    Attributes:
        seconds: how long.
    """

    wants_reply = False

    seconds: float = ruled(SECONDS, 0.727)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """Let all that is said from now on wait."""
        moment.did(f"nothing is said for {self.seconds:g} s")
        moment.line.stall(self.seconds)
        return reply


@kind("split")
@dataclass(frozen=True, slots=True, kw_only=True)
class Split(Fault):
    """There is a pause within the reply.

    Attributes:
        after_bytes: where; left out: at random.
        seconds: how long.
    """

    after_bytes: int | None = ruled(optional(whole(1, 4096)), None)
    seconds: float = ruled(SECONDS, 0.1)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """Cut the reply in two."""
        size = len(joined(reply))
        if size < 2 or (self.after_bytes or 0) >= size:
            return reply
        cut = self.after_bytes or moment.random.randrange(1, size)
        moment.did(f"{self.seconds:g} s between the first {cut} bytes and the other {size - cut}")
        return spread(reply, (cut,), self.seconds)


@kind("slow")
@dataclass(frozen=True, slots=True, kw_only=True)
class Slow(Fault):
    """The reply comes byte by byte, as over a slow line.

    Attributes:
        bits_per_second: a byte takes ten bits.
    """

    bits_per_second: float = ruled(number(1, 1e7), 9600)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """Cut the reply at every byte; the first takes its time as well."""
        pause = 10 / self.bits_per_second
        moment.did(f"a byte every {pause * 1e3:.3g} ms")
        cut = spread(reply, range(1, len(joined(reply))), pause)
        return (Piece(cut[0].pause + pause, cut[0].data), *cut[1:])


@kind("merged")
@dataclass(frozen=True, slots=True, kw_only=True)
class Merged(Fault):
    """The reply is held back, and comes in one piece with the next one, in front of it.

    Attributes:
        at_most_seconds: then it comes alone, if no other reply has come.
    """

    at_most_seconds: float = ruled(SECONDS, 1.0)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """Keep the reply, unless one is kept: that one goes with this."""
        if not moment.hold(self.at_most_seconds, reply):
            return reply
        moment.did("held for the next reply")
        return ()
