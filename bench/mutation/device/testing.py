"""The device tester, with leave for everything, on a peer in memory and in stepped time."""

from __future__ import annotations

from collections.abc import Iterator

from cobotwire.conformance.device import EVERYTHING, Leave, Line, Tester
from cobotwire.conformance.report import Result, Verdict
from cobotwire.sim.clock import SteppedClock
from cobotwire.sim.memory import MemoryLink
from cobotwire.sim.peer import Peer
from cobotwire.table import Table

BAD = (Verdict.FAIL, Verdict.UNSTABLE)
# Every joint may go so far, and as fast as it can: nothing here can be hurt.
WORKSPACE = (-60.0, 60.0)
FASTEST = 100


def complaints(table: Table, peer: Peer, clock: SteppedClock) -> Iterator[str]:
    """What the tester finds wrong, as it finds it: command, rule and reason."""
    for result in results(table, peer, clock):
        if result.verdict in BAD:
            place = f"{result.command}: " if result.command else ""
            yield f"{place}{result.rule}: {result.reason}"


def results(table: Table, peer: Peer, clock: SteppedClock) -> Iterator[Result]:
    """The results of a whole run, step by step."""
    leave = Leave.of(
        EVERYTHING,
        joints=table.joints,
        max_speed=FASTEST,
        workspace=dict.fromkeys(range(1, table.joints + 1), WORKSPACE),
    )
    tester = Tester(Line(MemoryLink(peer, clock), clock), table, leave=leave)
    for step in tester.steps():
        yield from tester.results(step)
