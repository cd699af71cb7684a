"""Faults that lose bytes, and say nothing else in their place."""

from __future__ import annotations

from dataclasses import dataclass

from cobotwire.sim.faults.exchange import Reply
from cobotwire.sim.faults.fault import Damage, Fault, Moment
from cobotwire.sim.faults.registry import kind
from cobotwire.sim.faults.rules import SECONDS, optional, ruled, whole


@kind("lost")
@dataclass(frozen=True, slots=True, kw_only=True)
class Lost(Damage):
    """The reply is lost; or the request, so that the arm does nothing."""

    def spoil(self, data: bytes, moment: Moment) -> bytes:
        """Nothing is left."""
        moment.did(f"{len(data)} bytes of the {self.of} lost")
        return b""


@kind("truncated")
@dataclass(frozen=True, slots=True, kw_only=True)
class Truncated(Damage):
    """What stands behind some byte is lost.

    Attributes:
        after_bytes: so many are left; left out: at random, at least one less than all.
    """

    after_bytes: int | None = ruled(optional(whole(1, 4096)), None)

    def spoil(self, data: bytes, moment: Moment) -> bytes:
        """The beginning is left."""
        left = self.after_bytes or moment.random.randrange(len(data))
        if left < len(data):
            moment.did(f"{left} of {len(data)} bytes of the {self.of} left")
        return data[:left]


@kind("dropped")
@dataclass(frozen=True, slots=True, kw_only=True)
class Dropped(Damage):
    """Some bytes are missing, and what stands behind them moves up.

    Attributes:
        byte: where, from 0; left out: at random.
        count: how many.
    """

    byte: int | None = ruled(optional(whole(0, 4095)), None)
    count: int = ruled(whole(1, 4096), 1)

    def spoil(self, data: bytes, moment: Moment) -> bytes:
        """Take them out."""
        place = moment.random.randrange(len(data)) if self.byte is None else self.byte
        gone = data[place : place + self.count]
        if gone:
            moment.did(f"{gone.hex(' ').upper()} missing at byte {place} of the {self.of}")
        return data[:place] + data[place + self.count :]


@kind("silent")
@dataclass(frozen=True, slots=True, kw_only=True)
class Silent(Fault):
    """For a while the arm neither hears nor says anything; this request is the first that is lost.

    Attributes:
        seconds: how long.
    """

    wants_reply = False

    seconds: float = ruled(SECONDS, 1.0)

    def hear(self, data: bytes, moment: Moment) -> bytes:
        """Nothing is heard, and nothing more is said of what was heard before."""
        unsaid = moment.drop_unsaid()
        moment.line.deafen(self.seconds)
        also = f", {unsaid} bytes unsaid" if unsaid else ""
        moment.did(f"for {self.seconds:g} s{also}")
        return b""

    def say(self, reply: Reply, moment: Moment) -> Reply:
        """Nothing was heard."""
        return ()


@kind("frozen")
@dataclass(frozen=True, slots=True, kw_only=True)
class Frozen(Fault):
    """The firmware hangs from this request on, until ``power_cycle()`` is called."""

    wants_reply = False

    def hear(self, data: bytes, moment: Moment) -> bytes:
        """The request is what it hangs on."""
        moment.did("hangs until a power cycle")
        moment.line.deafen()
        return b""
