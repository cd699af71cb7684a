"""Create the simulated arm of a test, and the client that is connected to it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.client import Client
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator import (
    MemoryTransport,
    PtyServer,
    RunningClock,
    Server,
    SimulatedArm,
    SteppedClock,
    TcpServer,
)
from cobotwire.simulator.clock import Clock
from cobotwire.simulator.local import local_server
from cobotwire.simulator.peer import Peer
from cobotwire.simulator.testing.options import ArmOptions, WrapsPeer


@contextmanager
def connected(options: ArmOptions) -> Iterator[Client]:
    """Yield a connected client of the edition; close it and the arm at the end.

    Raises:
        UsageError: there is no such edition, scenario or transport.
    """
    package = editions.load(options.edition)
    if options.transport in ("pty", "tcp"):
        with served(options) as url, package.CLIENT(url) as arm:
            yield arm
        return
    clock = SteppedClock()
    simulated = _Arm(options, package.TABLE, clock)
    with package.CLIENT(MemoryTransport(simulated.connect(), clock)) as client:
        yield client


@contextmanager
def served(options: ArmOptions) -> Iterator[str]:
    """Yield the port of an arm that a thread serves.

    Raises:
        UsageError: there is no such edition, scenario or transport.
    """
    if options.transport == "memory":
        message = "simulated_arm_url needs the transport pty or tcp: one in memory has no URL"
        raise UsageError("transport", "memory", message=message)
    clock = RunningClock(options.speed)
    arm = _Arm(options, editions.load(options.edition).TABLE, clock)
    with _server(options.transport, arm, clock) as server:
        yield server.url


def _server(transport: str | None, arm: _Arm, clock: RunningClock) -> Server:
    if transport == "tcp":
        return TcpServer(arm.connect, clock=clock)
    return (PtyServer if transport == "pty" else local_server)(arm.connect(), clock)


class _Arm:
    """One arm, and the faults before each connection to it."""

    def __init__(self, options: ArmOptions, table: Table, clock: Clock) -> None:
        self._arm = SimulatedArm(table, clock=clock)
        self._codec = codecs.load(table)
        self._clock, self._seed = clock, options.seed
        self._faults: WrapsPeer | None = options.wrapping(table)

    def connect(self) -> Peer:
        connection = self._arm.connect()
        if self._faults is None:
            return connection
        return self._faults.wrap(connection, self._codec, clock=self._clock, seed=self._seed)
