"""Send requests to a faulty peer in memory, and record its replies, in stepped time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.simulator import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.faults import AppliedFault, Fault, Scenario
from cobotwire.simulator.peer import Peer
from playing import play

CODEC = codecs.load(TABLE)
IS_POWERED = bytes.fromhex("FE FE 02 12 FA")
OFF = bytes.fromhex("FE FE 03 12 00 FA")
POWER_ON = bytes.fromhex("FE FE 02 10 FA")
ACK = bytes.fromhex("FE FE 03 10 01 FA")
GET_ANGLES = bytes.fromhex("FE FE 02 20 FA")
ZEROS = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
# After this many seconds, even the longest fault of the tests has sent everything.
LONG = 30.0


class Tapped:
    """A peer that records the bytes it sends."""

    def __init__(self, peer: Peer, restart: Callable[[], None]) -> None:
        self.sent: list[bytes] = []
        self.restart = restart
        self._peer = peer

    @property
    def wait(self) -> float | None:
        return self._peer.wait

    def receive(self, data: bytes) -> bytes:
        return self._noted(self._peer.receive(data))

    def flush(self) -> bytes:
        return self._noted(self._peer.flush())

    def _noted(self, data: bytes) -> bytes:
        self.sent += [data] if data else []
        return data


class Talk(NamedTuple):
    """The received bytes with their times, the applied faults, and the bytes that the arm sent."""

    received: list[tuple[float, bytes]]
    applied: list[AppliedFault]
    sent: list[bytes]

    @property
    def data(self) -> bytes:
        return b"".join(data for _, data in self.received)


def talk(
    faults: Sequence[Fault],
    requests: Sequence[bytes | float],
    *,
    seed: int = 0,
    size: int | None = None,
) -> Talk:
    """Send each item of bytes, wait each number of seconds.

    With ``size``, each item of bytes is sent in pieces of that size, without a pause.
    """
    clock = SteppedClock()
    applied: list[AppliedFault] = []
    arm = SimulatedArm(TABLE, clock=clock)
    tapped = Tapped(arm, arm.restart)
    scenario = Scenario(name="test", faults=tuple(faults), seed=seed)
    peer = scenario.wrap(tapped, CODEC, clock=clock, on_fault=applied.append)
    writes: list[tuple[float, bytes]] = []
    for step in (*requests, LONG):
        if isinstance(step, float):
            writes.append((step, b""))
        else:
            most = size or len(step)
            writes += [(0.0, step[at : at + most]) for at in range(0, len(step), most)]
    return Talk(play(peer, clock, writes), applied, tapped.sent)
