"""A fault of the controller: a panic and the restart after it."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.simulator.faults.exchange import Piece, Reply, joined
from cobotwire.simulator.faults.fault import Context, Fault
from cobotwire.simulator.faults.noise import BOOT, PANIC, REBOOT_NULS, at_other_rate
from cobotwire.simulator.faults.registry import kind
from cobotwire.simulator.faults.rules import SECONDS, integer, number, ruled


@kind("panic")
@dataclass(frozen=True, slots=True, kw_only=True)
class Panic(Fault):
    """The firmware panics and restarts: it sends text, NULs, and boot output at another baud rate.

    Meanwhile the arm receives nothing; afterwards it has lost its state.

    Attributes:
        after_bytes: how many bytes of the reply come before the panic.
        nuls: how many NULs follow the text.
        rate_ratio: the line's baud rate divided by that of the boot output.
        deaf_seconds: for how long the arm receives nothing.
    """

    wants_reply = False

    after_bytes: int = ruled(integer(0, 4096), 0)
    nuls: int = ruled(integer(0, 4096), REBOOT_NULS)
    rate_ratio: float = ruled(number(2, 64), 4.0)
    deaf_seconds: float = ruled(SECONDS, 0.5)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Send the beginning of the reply, and then what a restarting controller sends."""
        begun = joined(reply)[: self.after_bytes]
        boot = at_other_rate(BOOT, self.rate_ratio)
        context.report(f"panic, {self.nuls} NULs, deaf for {self.deaf_seconds:g} s, state lost")
        context.drop_unsent()
        context.connection.deafen(self.deaf_seconds)
        context.connection.restart()
        half = self.deaf_seconds / 2
        pieces = (Piece(0.0, begun + PANIC), Piece(half, bytes(self.nuls)), Piece(half, boot))
        return tuple(piece for piece in pieces if piece.data)
