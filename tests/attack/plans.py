"""Plans: runs of a profile, drawn from a seed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from random import Random
from typing import Literal

from attack.profiles import Clients, Profile
from cobotwire.simulator.faults import Duplicated, Fault, Late


@dataclass(frozen=True)
class Plan:
    """One run: everything that its seed decides.

    Attributes:
        profile: what the line and the users do.
        seed: repeats the draws of the run, not its timing.
        tcp: whether the line is TCP; otherwise it is a pty.
        client: the blocking or asyncio client of Python, either client of Rust, or Node's.
        codec: the codec of the Python client, native or reference.
        edition: the edition's package.
        users: how many threads or tasks share the client.
        timeout: the timeout of each request, in seconds.
        attempts: how often a query is sent at most.
        grace: seconds for which late replies are expected; the delays of the line fit into it.
        seconds: how long users call.
        calls: after how many calls the run ends early.
        restores: whether a client that got a LinkError is replaced.
        reopens: whether its transport is reopened instead.
        deadline: seconds that each call may take as a whole; None: any time.
    """

    profile: Profile
    seed: int
    tcp: bool
    client: Clients
    codec: Literal["native", "reference"]
    edition: Literal["mycobot280", "mycobot"]
    users: int
    timeout: float
    attempts: int
    grace: float
    seconds: float
    calls: int
    restores: bool
    reopens: bool
    deadline: float | None

    @property
    def faults(self) -> tuple[Fault, ...]:
        """The faults of the profile, with delays that fit into the grace."""
        return tuple(_scaled(fault, self.grace) for fault in self.profile.faults)

    @property
    def apart(self) -> bool:
        """Whether a client in a process of its own is attacked: in Rust or in Node."""
        return self.client.startswith(("rust", "node"))

    @property
    def _recovery(self) -> str:
        if not self.restores:
            return ""
        return ", reopens" if self.reopens else ", new clients"

    def __str__(self) -> str:
        kind = "tcp" if self.tcp else "pty"
        return (
            f"profile {self.profile.name}, seed {self.seed}: {kind}, {self.client}, {self.codec}, "
            f"{self.edition}, {self.users} users, timeout {self.timeout} s x {self.attempts}, "
            f"grace {self.grace} s, deadline {self.deadline}" + self._recovery
        )


def _scaled(fault: Fault, grace: float) -> Fault:
    if isinstance(fault, Late):
        jitter = fault.jitter_seconds * grace
        return replace(fault, seconds=fault.seconds * grace, jitter_seconds=jitter)
    if isinstance(fault, Duplicated):
        return replace(fault, seconds=fault.seconds * grace)
    return fault


def plan(profile: Profile, seed: int, seconds: float | None = None, calls: int = 5000) -> Plan:
    """Draw the plan of a run from its seed."""
    random = Random(f"{profile.name} {seed}")
    client = random.choice(profile.clients)
    return Plan(
        profile,
        seed,
        # Only a pty accepts part of a frame. TCP may lose bytes that are written just before it
        # is closed. Serial ports in Node need a third-party package.
        tcp=(random.random() < (0.2 if profile.stalls else 0.5) and not profile.signals)
        or client == "node",
        client=client,
        codec=random.choice(("native", "reference")),
        edition=random.choice(("mycobot280", "mycobot280", "mycobot")),
        users=random.randint(2 + 2 * profile.fresh, 8)
        if profile.interrupts or profile.fresh
        else random.randint(1, 8),
        timeout=random.choice((0.2, 0.3, 0.5)),
        attempts=random.choice((1, 2, 3)),
        grace=random.choice((0.3, 1.0)),
        seconds=profile.seconds if seconds is None else seconds,
        calls=calls,
        restores=profile.disconnects or (profile.stalls and random.random() < 0.4),
        reopens=client == "blocking" and random.random() < 0.5,
        deadline=random.choice((None, None, 0.4)),
    )
