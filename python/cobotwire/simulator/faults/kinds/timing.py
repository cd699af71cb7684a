"""Faults of time: every byte arrives, but not when it should."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.simulator.faults.exchange import Piece, Reply, joined, spread
from cobotwire.simulator.faults.fault import Context, Fault
from cobotwire.simulator.faults.registry import kind
from cobotwire.simulator.faults.rules import SECONDS, integer, number, optional, ruled


@kind("late")
@dataclass(frozen=True, slots=True, kw_only=True)
class Late(Fault):
    """The reply is late; replies to later requests may overtake it.

    Attributes:
        seconds: how late.
        jitter_seconds: the longest additional delay, which is random for each reply.
    """

    seconds: float = ruled(SECONDS, 0.1)
    jitter_seconds: float = ruled(SECONDS, 0.0)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Delay the reply; its bytes stay the same."""
        seconds = self.seconds + context.random.uniform(0, self.jitter_seconds)
        context.report(f"{seconds:.3f} s late")
        context.delay += seconds
        return reply


@kind("stalled")
@dataclass(frozen=True, slots=True, kw_only=True)
class Stalled(Fault):
    """The arm stalls: it receives, but sends nothing for a while, and then all replies in order.

    Attributes:
        seconds: for how long.
    """

    wants_reply = False

    seconds: float = ruled(SECONDS, 0.727)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Hold back all replies from now on."""
        context.report(f"nothing is sent for {self.seconds:g} s")
        context.connection.stall(self.seconds)
        return reply


@kind("split")
@dataclass(frozen=True, slots=True, kw_only=True)
class Split(Fault):
    """There is a pause within the reply.

    Attributes:
        after_bytes: after how many bytes; None: random.
        seconds: how long the pause is.
    """

    after_bytes: int | None = ruled(optional(integer(1, 4096)), None)
    seconds: float = ruled(SECONDS, 0.1)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Cut the reply in two."""
        size = len(joined(reply))
        if size < 2 or (self.after_bytes or 0) >= size:
            return reply
        cut = self.after_bytes or context.random.randrange(1, size)
        first, rest = f"the first {cut} bytes", f"the other {size - cut}"
        context.report(f"{self.seconds:g} s between {first} and {rest}")
        return spread(reply, (cut,), self.seconds)


@kind("slow")
@dataclass(frozen=True, slots=True, kw_only=True)
class Slow(Fault):
    """The reply comes byte by byte, as over a slow line.

    Attributes:
        bits_per_second: the speed; a byte takes ten bits.
    """

    bits_per_second: float = ruled(number(1, 1e7), 9600)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Put a pause before every byte, the first one included."""
        pause = 10 / self.bits_per_second
        context.report(f"a byte every {pause * 1e3:.3g} ms")
        cut = spread(reply, range(1, len(joined(reply))), pause)
        return (Piece(cut[0].pause + pause, cut[0].data), *cut[1:])


@kind("merged")
@dataclass(frozen=True, slots=True, kw_only=True)
class Merged(Fault):
    """The reply is held back, and sent in one piece with the next one, which follows it.

    Attributes:
        at_most_seconds: after this time it is sent without another reply.
    """

    at_most_seconds: float = ruled(SECONDS, 1.0)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Hold the reply back, unless another one is held: then send both."""
        if not context.hold(self.at_most_seconds, reply):
            return reply
        context.report("held back for the next reply")
        return ()
