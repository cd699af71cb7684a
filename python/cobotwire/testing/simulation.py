"""The simulated arm that a test wants, and the client that is connected to it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.driver import Driver
from cobotwire.errors import UsageError
from cobotwire.sim import (
    MemoryLink,
    PtyPort,
    RunningClock,
    Server,
    SimulatedArm,
    SteppedClock,
    TcpPort,
)
from cobotwire.sim.clock import Clock
from cobotwire.sim.peer import Peer
from cobotwire.table import Table
from cobotwire.testing.wanted import Wanted, Wraps


@contextmanager
def connected(wanted: Wanted) -> Iterator[Driver]:
    """A client of the edition, connected; closed at the end, and the arm with it.

    Raises:
        UsageError: there is no such edition, scenario or link.
    """
    package = editions.load(wanted.edition)
    if wanted.link in ("pty", "tcp"):
        with served(wanted) as url, package.CLIENT(url) as arm:
            yield arm
        return
    clock = SteppedClock()
    simulated = _Arm(wanted, package.TABLE, clock)
    with package.CLIENT(MemoryLink(simulated.line(), clock)) as client:
        yield client


@contextmanager
def served(wanted: Wanted) -> Iterator[str]:
    """The port of an arm that is served until the end, in a thread.

    Raises:
        UsageError: there is no such edition, scenario or link.
    """
    if wanted.link == "memory":
        raise UsageError("link", "memory", "pty or tcp: a link in memory has no URL")
    clock = RunningClock(wanted.speed)
    arm = _Arm(wanted, editions.load(wanted.edition).TABLE, clock)
    server: Server
    server = TcpPort(arm.line, clock=clock) if wanted.link == "tcp" else PtyPort(arm.line(), clock)
    with server:
        yield server.url


class _Arm:
    """One arm, and what each client's line to it goes through."""

    def __init__(self, wanted: Wanted, table: Table, clock: Clock) -> None:
        self._arm = SimulatedArm(table, clock=clock)
        self._codec = codecs.load(table)
        self._clock, self._seed = clock, wanted.seed
        self._wraps: Wraps | None = wanted.wrapping(table)

    def line(self) -> Peer:
        line = self._arm.another_line()
        if self._wraps is None:
            return line
        return self._wraps.wrap(line, self._codec, clock=self._clock, seed=self._seed)
