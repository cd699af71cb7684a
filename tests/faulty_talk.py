"""What is said to a faulty peer in memory, and what comes back when, in stepped time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from cobotwire import codec as codecs
from cobotwire.editions.mycobot280 import TABLE
from cobotwire.sim import SimulatedArm
from cobotwire.sim.clock import SteppedClock
from cobotwire.sim.faults import Done, Fault, Scenario
from cobotwire.sim.peer import Peer

CODEC = codecs.load(TABLE)
IS_POWERED = bytes.fromhex("FE FE 02 12 FA")
OFF = bytes.fromhex("FE FE 03 12 00 FA")
POWER_ON = bytes.fromhex("FE FE 02 10 FA")
ACK = bytes.fromhex("FE FE 03 10 01 FA")
GET_ANGLES = bytes.fromhex("FE FE 02 20 FA")
ZEROS = bytes.fromhex("FE FE 0E 20") + bytes(12) + b"\xfa"
# What the longest fault of the tests has said by then.
LONG = 30.0


class Tapped:
    """A peer that notes each thing that it says."""

    def __init__(self, peer: Peer, restart: Callable[[], None]) -> None:
        self.said: list[bytes] = []
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
        self.said += [data] if data else []
        return data


class Talk(NamedTuple):
    """All that came back, with its time; what was done; what the arm had said."""

    heard: list[tuple[float, bytes]]
    done: list[Done]
    said: list[bytes]

    @property
    def data(self) -> bytes:
        return b"".join(data for _, data in self.heard)


def talk(
    faults: Sequence[Fault],
    requests: Sequence[bytes | float],
    *,
    seed: int = 0,
    size: int | None = None,
) -> Talk:
    """Say bytes, wait seconds; ``size``: the bytes come in pieces of that size, at one time."""
    clock = SteppedClock()
    done: list[Done] = []
    arm = SimulatedArm(TABLE, clock=clock)
    tapped = Tapped(arm, arm.restart)
    scenario = Scenario(name="test", faults=tuple(faults), seed=seed)
    peer = scenario.wrap(tapped, CODEC, clock=clock, watch=done.append)
    heard: list[tuple[float, bytes]] = []
    for step in (*requests, LONG):
        if isinstance(step, float):
            pass_time(peer, clock, step, heard)
            continue
        pieces = (
            [step] if size is None else [step[at : at + size] for at in range(0, len(step), size)]
        )
        for piece in pieces:
            _note(heard, clock(), peer.receive(piece))
    return Talk(heard, done, tapped.said)


def pass_time(
    peer: Peer, clock: SteppedClock, seconds: float, heard: list[tuple[float, bytes]]
) -> None:
    """Wake the peer whenever it wants to be woken."""
    until = clock() + seconds
    for _ in range(100_000):
        wait = peer.wait
        if wait is None or clock() + wait > until:
            clock.sleep(until - clock())
            return
        clock.sleep(wait)
        _note(heard, clock(), peer.flush())
    raise AssertionError("the peer wants to be woken for ever")


def _note(heard: list[tuple[float, bytes]], now: float, data: bytes) -> None:
    if not data:
        return
    if heard and heard[-1][0] == now:
        heard[-1] = (now, heard[-1][1] + data)
    else:
        heard.append((now, data))
