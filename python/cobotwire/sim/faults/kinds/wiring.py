"""Faults of how the line is set up: another baud rate, flow control, a port that goes."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.sim.faults.exchange import Reply
from cobotwire.sim.faults.fault import Damage, Fault, Moment
from cobotwire.sim.faults.noise import at_other_rate
from cobotwire.sim.faults.registry import kind
from cobotwire.sim.faults.rules import SECONDS, number, ruled
from cobotwire.sim.peer import LineGone

XON, XOFF = b"\x11", b"\x13"


@kind("wrong-baud")
@dataclass(frozen=True, slots=True, kw_only=True)
class WrongBaud(Damage):
    """The two sides differ in their baud rate; what comes is garbage.

    Attributes:
        slower_times: so many times slower is the sender.
    """

    slower_times: float = ruled(number(2, 64), 4.0)

    def spoil(self, data: bytes, moment: Moment) -> bytes:
        """Read each bit so many times."""
        garbage = at_other_rate(data, self.slower_times)
        moment.did(f"{len(data)} bytes read as {garbage.hex(' ').upper()}")
        return garbage


@kind("flow-control")
@dataclass(frozen=True, slots=True, kw_only=True)
class FlowControl(Damage):
    """XON/XOFF was left on: 11 and 13 are eaten, and a 13 stops the other side.

    Attributes:
        seconds: how long a 13 in a reply stops what the host says, unless a 11 comes behind it; it
            is heard afterwards.
    """

    seconds: float = ruled(SECONDS, 1.0)

    def spoil(self, data: bytes, moment: Moment) -> bytes:
        """Eat both bytes."""
        left = data.replace(XON, b"").replace(XOFF, b"")
        if left == data:
            return data
        stops = data.rfind(XOFF) > data.rfind(XON) and self.of == "reply"
        if stops:
            moment.line.stop(self.seconds)
        what = f"{len(data) - len(left)} bytes of the {self.of} eaten"
        moment.did(what + (f", the host is stopped for {self.seconds:g} s" if stops else ""))
        return left


@kind("unplugged")
@dataclass(frozen=True, slots=True, kw_only=True)
class Unplugged(Fault):
    """The port goes away: :class:`cobotwire.sim.peer.LineGone` is raised to what serves it."""

    wants_reply = False

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """The line ends here."""
        moment.did("the port is gone")
        raise LineGone
