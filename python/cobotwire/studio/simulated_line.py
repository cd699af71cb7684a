"""The simulated arm that is shown without a port, and its fault scenario."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple
from weakref import WeakSet

from cobotwire import codec as codecs
from cobotwire.protocol.errors import CobotwireError, UsageError
from cobotwire.protocol.table import Table
from cobotwire.simulator import ArmConnection, RunningClock, SimulatedArm, TcpServer
from cobotwire.simulator.arm import Note
from cobotwire.simulator.faults import AppliedFault, Scenario, find, shipped
from cobotwire.simulator.peer import Peer
from cobotwire.studio.arm_line import Remark

Wrap = Callable[[ArmConnection], Peer]


class ScenarioChoice(NamedTuple):
    """A scenario that comes with cobotwire."""

    name: str
    about: str


class SimulatedLine:
    """Serves a simulated arm over TCP on this machine while its ``with`` block runs."""

    def __init__(self, table: Table, on_remark: Remark) -> None:
        """Create the arm; ``on_remark`` gets each fault and note in the server's thread."""
        self.table = table
        self._on_remark = on_remark
        self._clock = RunningClock()
        self._arm = SimulatedArm(table, clock=self._clock, on_note=self._note, powered=True)
        self._scenario: Scenario | None = None
        # The peers of all connected clients: other programs may connect to the arm too.
        self._peers: WeakSet[SwitchedPeer] = WeakSet()
        self._server = TcpServer(self._connect, clock=self._clock)
        self.url = self._server.url

    def __enter__(self) -> SimulatedLine:
        self._server.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self._server.__exit__(*error)

    @property
    def scenario(self) -> str:
        """The name of the scenario; empty: no faults are injected."""
        return "" if self._scenario is None else self._scenario.name

    def choose(self, name: str) -> None:
        """Begin a scenario; an empty name ends it.

        Raises:
            UsageError: there is no such scenario, or the edition lacks a command of it.
            ScenarioError: the scenario does not fit the edition.
        """
        # Only by name: a page must not read files.
        if name and name not in shipped():
            raise UsageError("scenario", name, ", ".join(shipped()))
        self._scenario = find(name, self.table) if name else None
        for peer in tuple(self._peers):
            peer.wrap_next(self._wrapped)

    def _connect(self) -> Peer:
        peer = SwitchedPeer(self._arm.connect(lambda event, reply: None))
        peer.wrap_next(self._wrapped)
        self._peers.add(peer)
        return peer

    def _wrapped(self, arm: ArmConnection) -> Peer:
        if self._scenario is None:
            return arm
        codec = codecs.load(self.table)
        on_fault = partial(_report_fault, self._on_remark)
        return self._scenario.wrap(arm, codec, clock=self._clock, on_fault=on_fault)

    def _note(self, note: Note) -> None:
        self._on_remark("note", f"{note.command}: {note.text}")


class SwitchedPeer:
    """The arm's end of a connection, with or without faults; the server's thread switches it."""

    def __init__(self, arm: ArmConnection) -> None:
        self._arm = arm
        self._peer: Peer = arm
        self._next: Wrap | None = None

    def wrap_next(self, wrap: Wrap) -> None:
        """Let ``wrap`` choose the peer before the next bytes; any thread may call this."""
        self._next = wrap

    @property
    def wait(self) -> float | None:
        """Seconds until :meth:`flush` must be called if nothing is received; None: never."""
        return self._peer.wait

    def receive(self, data: bytes) -> bytes:
        """Receive ``data``; return what is to be sent at once."""
        wrap, self._next = self._next, None
        if wrap is not None:
            self._peer = wrap(self._arm)
        return self._peer.receive(data)

    def flush(self) -> bytes:
        """Return what is to be sent now, without new data."""
        return self._peer.flush()


def scenarios(table: Table) -> list[ScenarioChoice]:
    """Return the scenarios that fit an edition; none if ruamel.yaml is not installed."""
    found = []
    for name in shipped():
        try:
            scenario = find(name, table)
        except CobotwireError:
            continue
        # A scenario that replays a recording would replace the simulated arm.
        if scenario.replay is None:
            found.append(ScenarioChoice(name, scenario.about))
    return found


def _report_fault(on_remark: Remark, done: AppliedFault) -> None:
    on_remark(f"fault {done.fault}", f"{done.request}: {done.detail}")
