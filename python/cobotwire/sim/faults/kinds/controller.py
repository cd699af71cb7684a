"""The controller fails: a panic, and what comes of it."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.sim.faults.exchange import Piece, Reply, joined
from cobotwire.sim.faults.fault import Fault, Moment
from cobotwire.sim.faults.noise import BOOT, PANIC, REBOOT_NULS, at_other_rate
from cobotwire.sim.faults.registry import kind
from cobotwire.sim.faults.rules import SECONDS, number, ruled, whole


@kind("panic")
@dataclass(frozen=True, slots=True, kw_only=True)
class Panic(Fault):
    """The firmware panics and starts again: text, NULs, boot output at another baud rate.

    Meanwhile the arm hears nothing, and afterwards it has lost its state.

    Attributes:
        after_bytes: so many bytes of the reply come before it; 0: none.
        nuls: how many follow the text.
        slower_times: so many times slower than the line is the boot output.
        deaf_seconds: how long the arm hears nothing.
    """

    wants_reply = False

    after_bytes: int = ruled(whole(0, 4096), 0)
    nuls: int = ruled(whole(0, 4096), REBOOT_NULS)
    slower_times: float = ruled(number(2, 64), 4.0)
    deaf_seconds: float = ruled(SECONDS, 0.5)

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """The beginning of the reply, and then what a controller says that starts again."""
        begun = joined(reply)[: self.after_bytes]
        boot = at_other_rate(BOOT, self.slower_times)
        moment.did(f"panic, {self.nuls} NULs, deaf for {self.deaf_seconds:g} s, state lost")
        moment.drop_unsaid()
        moment.line.deafen(self.deaf_seconds)
        moment.line.lose_state()
        half = self.deaf_seconds / 2
        pieces = (Piece(0.0, begun + PANIC), Piece(half, bytes(self.nuls)), Piece(half, boot))
        return tuple(piece for piece in pieces if piece.data)
