"""The profiles: what the line and the users of a run do."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

from cobotwire.simulator.faults import (
    CommandError,
    Corrupted,
    Dropped,
    Duplicated,
    Echo,
    Fault,
    Late,
    Lost,
    Merged,
    Noise,
    ServoLeak,
    Split,
    Truncated,
)

Clients = Literal["blocking", "asyncio", "rust", "rust async", "node"]


@dataclass(frozen=True)
class Profile:
    """A kind of run.

    Attributes:
        name: the row of the table.
        about: what is hostile about it.
        faults: what the line does to requests and replies.
        one_way: the share of one-way requests.
        weight: its share of the time, relative to the others.
        seconds: how long one run takes.
        breaks: how many seconds pass between two breaks of the line; 0: it does not break.
        closes: how many seconds pass until the client is closed and opened; 0: it is not.
        stalls: whether the peer stops reading now and then.
        interrupts: whether Ctrl-C is raised in the main thread.
        cancels: whether calls are cancelled.
        fresh: whether the users run in a fresh process.
        signals: whether Ctrl-C is a real signal; one of them ends the ``with`` block of the client.
        clients: which clients run it.
    """

    name: str
    about: str
    faults: tuple[Fault, ...] = ()
    one_way: float = 0.25
    weight: float = 1.0
    seconds: float = 2.0
    breaks: float = 0.0
    closes: float = 0.0
    stalls: bool = False
    interrupts: bool = False
    cancels: bool = False
    fresh: bool = False
    signals: bool = False
    clients: tuple[Clients, ...] = field(default=("blocking", "asyncio"))

    @property
    def disconnects(self) -> bool:
        """Whether the connection ends during the run."""
        return bool(self.breaks or self.closes)


SOMETIMES_LATE = Late(seconds=0.05, jitter_seconds=0.7, probability=0.05)
_ALL = (
    Profile("benign", "nothing is wrong", weight=3.0),
    Profile(
        "fair",
        "a little noise, some replies lost, in pieces or up to 20 ms late",
        (
            Late(jitter_seconds=0.02, seconds=0.0, probability=0.2),
            Noise(probability=0.03),
            Split(seconds=0.005, probability=0.05),
            Lost(probability=0.01),
        ),
        weight=1.5,
    ),
    Profile(
        "harsh",
        "noise, lost and damaged bytes in both directions, late and merged replies",
        (
            Corrupted(of="request", probability=0.01),
            Dropped(of="request", probability=0.01),
            Lost(of="request", probability=0.02),
            ServoLeak(probability=0.05),
            Noise(probability=0.1),
            Noise(where="inside", probability=0.02),
            CommandError(probability=0.5),
            Lost(probability=0.03),
            Truncated(probability=0.02),
            Dropped(probability=0.02),
            Corrupted(probability=0.03),
            Merged(at_most_seconds=0.2, probability=0.02),
            SOMETIMES_LATE,
        ),
        weight=1.5,
    ),
    Profile(
        "echo",
        "the line echoes every request",
        (Lost(probability=0.02), SOMETIMES_LATE, Echo()),
    ),
    Profile(
        "doubled",
        "replies come twice, some of them late",
        (
            Late(seconds=0.05, jitter_seconds=0.6, probability=0.1),
            Duplicated(probability=0.3),
            Duplicated(seconds=0.01, probability=0.2),
            Duplicated(seconds=0.2, probability=0.1),
        ),
        weight=1.5,
    ),
    Profile(
        "late",
        "replies are 0.2 to 0.9 s late",
        (Late(seconds=0.2, jitter_seconds=0.7, probability=0.4),),
        one_way=0.1,
        weight=1.5,
    ),
    Profile(
        "unplug",
        "the line breaks and returns, some replies are late",
        (Late(seconds=0.05, jitter_seconds=0.8, probability=0.1),),
        breaks=0.4,
        weight=1.5,
    ),
    Profile(
        "stall",
        "the peer stops reading until writes fail, then reads on",
        (),
        one_way=0.9,
        stalls=True,
        seconds=4.0,
    ),
    Profile(
        "close",
        "the client is closed and opened while late replies are outstanding",
        (Late(seconds=0.1, jitter_seconds=0.8, probability=0.15),),
        closes=0.3,
        weight=1.5,
    ),
    Profile(
        "interrupts",
        "Ctrl-C in the main thread while other threads call",
        (Late(seconds=0.0, jitter_seconds=0.02, probability=0.1), Lost(probability=0.005)),
        one_way=0.5,
        interrupts=True,
        clients=("blocking",),
        weight=1.5,
    ),
    Profile(
        "cancellations",
        "asyncio tasks are cancelled at any time",
        (Late(seconds=0.0, jitter_seconds=0.3, probability=0.1),),
        cancels=True,
        clients=("asyncio",),
        weight=1.5,
    ),
    Profile(
        "starts",
        "threads call in the first 0.1 s of a fresh process, among bytes of the servos",
        (ServoLeak(probability=0.6), Late(seconds=0.0, jitter_seconds=0.01, probability=0.2)),
        one_way=0.4,
        fresh=True,
        seconds=0.1,
        clients=("blocking",),
        weight=0.3,
    ),
    Profile(
        "signals",
        "signals interrupt the main thread of a fresh process, and end it while threads wait",
        (Late(seconds=0.0, jitter_seconds=0.3, probability=0.1), ServoLeak(probability=0.1)),
        one_way=0.5,
        interrupts=True,
        fresh=True,
        signals=True,
        seconds=0.5,
        clients=("blocking",),
        weight=0.5,
    ),
)
PROFILES = {profile.name: profile for profile in _ALL}
# The profiles of the Rust clients, in which no exception of Python can interrupt a call.
RUST_PROFILES = {
    name: replace(profile, clients=("rust async",) if profile.cancels else ("rust", "rust async"))
    for name, profile in PROFILES.items()
    if not profile.interrupts
}
NODE_PROFILES = {name: replace(each, clients=("node",)) for name, each in RUST_PROFILES.items()}
