"""Faults of the line itself: another baud rate, flow control, a port that disappears."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.simulator.faults.exchange import Reply
from cobotwire.simulator.faults.fault import Context, Damage, Fault
from cobotwire.simulator.faults.noise import at_other_rate
from cobotwire.simulator.faults.registry import kind
from cobotwire.simulator.faults.rules import SECONDS, number, ruled
from cobotwire.simulator.peer import PeerDisconnected

XON, XOFF = b"\x11", b"\x13"


@kind("wrong-baud")
@dataclass(frozen=True, slots=True, kw_only=True)
class WrongBaud(Damage):
    """The two sides use different baud rates; what arrives is garbage.

    Attributes:
        rate_ratio: the receiver's baud rate divided by the sender's.
    """

    rate_ratio: float = ruled(number(2, 64), 4.0)

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Return what the receiver reads."""
        garbage = at_other_rate(data, self.rate_ratio)
        context.report(f"{len(data)} bytes read as {garbage.hex(' ').upper()}")
        return garbage


@kind("flow-control")
@dataclass(frozen=True, slots=True, kw_only=True)
class FlowControl(Damage):
    """XON/XOFF was left on: the bytes 11 and 13 are swallowed, and a 13 stops the host.

    Attributes:
        seconds: how long the byte 13 (XOFF) in a reply stops the host, unless 11 (XON) follows it.
            What the host sends meanwhile arrives afterwards.
    """

    seconds: float = ruled(SECONDS, 1.0)

    def spoil(self, data: bytes, context: Context) -> bytes:
        """Swallow both bytes."""
        left = data.replace(XON, b"").replace(XOFF, b"")
        if left == data:
            return data
        stops = data.rfind(XOFF) > data.rfind(XON) and self.of == "reply"
        if stops:
            context.connection.stop(self.seconds)
        what = f"{len(data) - len(left)} bytes of the {self.of} swallowed"
        context.report(what + (f", the host is stopped for {self.seconds:g} s" if stops else ""))
        return left


@kind("unplugged")
@dataclass(frozen=True, slots=True, kw_only=True)
class Unplugged(Fault):
    """The port disappears: whatever serves it gets a :class:`PeerDisconnected`.

    Attributes:
        seconds: how long after the request; what is due earlier is sent.
    """

    wants_reply = False

    seconds: float = ruled(SECONDS, 0.0)

    def change_reply(self, reply: Reply, context: Context) -> Reply:
        """Disconnect, at once or later."""
        context.report("the port is gone" + (f" in {self.seconds:g} s" if self.seconds else ""))
        if not self.seconds:
            raise PeerDisconnected
        context.connection.disconnect(self.seconds)
        return reply
