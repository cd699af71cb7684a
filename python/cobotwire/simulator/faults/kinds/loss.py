"""Faults that lose bytes and send nothing in their place."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.simulator.faults.exchange import Reply, joined
from cobotwire.simulator.faults.fault import Context, Damage, Fault
from cobotwire.simulator.faults.registry import kind
from cobotwire.simulator.faults.rules import SECONDS, integer, optional, ruled


@kind("lost")
@dataclass(frozen=True, slots=True, kw_only=True)
class Lost(Damage):
    """The reply is lost; or the request is, and the arm does nothing."""

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Return no bytes."""
        context.report(f"{len(data)} bytes of the {self.of} lost")
        return b""


@kind("truncated")
@dataclass(frozen=True, slots=True, kw_only=True)
class Truncated(Damage):
    """The end is lost.

    Attributes:
        after_bytes: how many bytes are left; None: a random number, so that at least one is lost.
    """

    after_bytes: int | None = ruled(optional(integer(1, 4096)), None)

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Return the beginning."""
        left = self.after_bytes or context.random.randrange(len(data))
        if left < len(data):
            context.report(f"{left} of {len(data)} bytes of the {self.of} left")
        return data[:left]


@kind("dropped")
@dataclass(frozen=True, slots=True, kw_only=True)
class Dropped(Damage):
    """Bytes in the middle are lost.

    Attributes:
        byte: the index of the first lost byte, from 0; None: random.
        count: how many.
    """

    byte: int | None = ruled(optional(integer(0, 4095)), None)
    count: int = ruled(integer(1, 4096), 1)

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Return the other bytes."""
        place = context.random.randrange(len(data)) if self.byte is None else self.byte
        lost = data[place : place + self.count]
        if lost:
            context.report(f"{lost.hex(' ').upper()} missing at byte {place} of the {self.of}")
        return data[:place] + data[place + self.count :]


@kind("silent")
@dataclass(frozen=True, slots=True, kw_only=True)
class Silent(Fault):
    """For a while the arm receives and sends nothing; this request is the first that is lost.

    Attributes:
        seconds: for how long.
    """

    wants_reply = False

    seconds: float = ruled(SECONDS, 1.0)

    def change_request(self, data: bytes, context: Context) -> bytes:
        """Lose the request, and the replies to earlier ones that are not sent yet."""
        unsent = context.drop_unsent()
        context.connection.deafen(self.seconds)
        also = f", {unsent} bytes unsent" if unsent else ""
        context.report(f"for {self.seconds:g} s{also}")
        return b""

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Return no reply: the arm has not received the request; drop what other faults added."""
        if added := len(joined(reply)):
            context.report(f"{added} bytes of other faults not sent")
        return ()


@kind("frozen")
@dataclass(frozen=True, slots=True, kw_only=True)
class Frozen(Fault):
    """The firmware hangs from this request on, until ``power_cycle()`` is called."""

    wants_reply = False

    def change_request(self, data: bytes, context: Context) -> bytes:
        """Lose the request, and everything after it."""
        context.report("hangs until a power cycle")
        context.connection.deafen()
        return b""
