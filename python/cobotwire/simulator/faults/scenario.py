"""A scenario: what goes wrong on a line, as an object."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, runtime_checkable

from cobotwire.capture import read
from cobotwire.codec.interface import Codec
from cobotwire.protocol.errors import UsageError
from cobotwire.simulator.faults.chooser import check_commands, choosers
from cobotwire.simulator.faults.exchange import AppliedFault
from cobotwire.simulator.faults.fault import Fault
from cobotwire.simulator.faults.faulty import FaultyPeer
from cobotwire.simulator.peer import Peer
from cobotwire.simulator.replayed import ReplayedArm


@runtime_checkable
class Restarting(Protocol):
    """A peer that can lose its state, like an arm that restarts."""

    def restart(self) -> None:
        """Lose all state."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """Faults, in the order in which they are applied to a request and to its reply.

    Attributes:
        name: the name by which users select it.
        about: one sentence that says what goes wrong.
        faults: what goes wrong.
        seed: the seed of the random numbers.
        replay: a recording that replies in place of the wrapped peer.
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
        on_fault: Callable[[AppliedFault], None] | None = None,
        on_reply: Callable[[int], None] | None = None,
    ) -> FaultyPeer:
        """Return a peer that applies the faults to another one. The scenario's time begins now.

        Args:
            peer: what replies. If it has a method ``restart()``, a panic calls it.
            codec: the codec of the edition, which reads the requests.
            clock: returns the time in seconds; the same clock as the peer's.
            seed: replaces the scenario's seed; None: keeps it.
            on_fault: called with every fault that was applied.
            on_reply: called when the last byte of a reply has been sent, with the number of that
                reply: the peer's replies are counted from 0. A lost reply is never reported.

        Raises:
            UsageError: a fault names a command that the edition lacks.
            CaptureError: the file to be replayed is not a recording.
        """
        check_commands(self.faults, codec.table)
        if self.replay is not None:
            peer = _replayed(self.replay, codec, self.speed, clock)
        return FaultyPeer(
            peer,
            codec,
            choosers(self.faults, self.seed if seed is None else seed),
            clock=clock,
            on_fault=on_fault,
            on_reply=on_reply,
            restart=peer.restart if isinstance(peer, Restarting) else None,
        )


def _replayed(path: Path, codec: Codec, speed: float, clock: Callable[[], float]) -> ReplayedArm:
    with read(str(path)) as capture:
        packets = [packet for packet in capture if packet.interface == 0]
    arm = ReplayedArm(packets, codec, speed=speed, clock=clock)
    if not arm.requests:
        raise UsageError("replay", message=f"{path}: the recording contains no request to replay")
    return arm
