"""A scenario: what goes wrong on a line, as an object."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, runtime_checkable

from cobotwire.capture import read
from cobotwire.codec.interface import Codec
from cobotwire.errors import UsageError
from cobotwire.sim.faults.chooser import check_commands, choosers
from cobotwire.sim.faults.exchange import Done
from cobotwire.sim.faults.fault import Fault
from cobotwire.sim.faults.faulty import FaultyPeer
from cobotwire.sim.peer import Peer
from cobotwire.sim.replayed import ReplayedArm


@runtime_checkable
class Restarting(Protocol):
    """A peer that can lose its state, as an arm does that starts again."""

    def restart(self) -> None:
        """Forget everything."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """Faults, in the order in which they are done to a request and to its reply.

    Attributes:
        name: what it is called.
        about: one sentence.
        faults: what goes wrong.
        seed: another one, other draws.
        replay: a recording that answers instead of the peer that is wrapped.
        speed: 2 halves the recording's delays.

    Raises:
        UsageError: the speed is not above 0.
    """

    name: str
    about: str = ""
    faults: tuple[Fault, ...] = ()
    seed: int = 0
    replay: Path | None = None
    speed: float = 1.0

    def __post_init__(self) -> None:
        if not 0 < self.speed < float("inf"):
            raise UsageError("scenario.speed", self.speed, "a number above 0")

    def wrap(
        self,
        peer: Peer,
        codec: Codec,
        *,
        clock: Callable[[], float] = time.monotonic,
        seed: int | None = None,
        watch: Callable[[Done], None] | None = None,
    ) -> FaultyPeer:
        """Put the faults in front of a peer. The scenario's time begins now.

        Args:
            peer: who answers. Has it a method ``restart()``, a panic calls it.
            codec: of the edition by which requests are told apart.
            clock: gives the time in seconds; the peer's own.
            seed: in place of the scenario's.
            watch: called with every fault that was done.

        Raises:
            UsageError: a fault names a command that the edition lacks.
            CaptureError: the recording to be replayed is none.
        """
        check_commands(self.faults, codec.table)
        if self.replay is not None:
            peer = _replayed(self.replay, codec, self.speed, clock)
        return FaultyPeer(
            peer,
            codec,
            choosers(self.faults, self.seed if seed is None else seed),
            clock=clock,
            watch=watch,
            restart=peer.restart if isinstance(peer, Restarting) else None,
        )


def _replayed(path: Path, codec: Codec, speed: float, clock: Callable[[], float]) -> ReplayedArm:
    with read(str(path)) as capture:
        packets = [packet for packet in capture if packet.interface == 0]
    arm = ReplayedArm(packets, codec, speed=speed, clock=clock)
    if not arm.requests:
        raise UsageError("replay", str(path), "a recording in which something is sent")
    return arm
