"""The device tester, with leave for everything, on a peer in memory and in stepped time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

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


class Complaint(NamedTuple):
    """A rule that the tester finds broken, of one command or of the whole line, and why."""

    command: str
    rule: str
    reason: str

    def __str__(self) -> str:
        return ": ".join(part for part in self if part)


def complaints(
    table: Table, peer: Peer, clock: SteppedClock, only: str = ""
) -> Iterator[Complaint]:
    """What the tester finds wrong, as it finds it; ``only`` leaves out all other commands."""
    for result in results(table, peer, clock, only):
        if result.verdict in BAD:
            yield Complaint(result.command, result.rule, result.reason)


def results(table: Table, peer: Peer, clock: SteppedClock, only: str = "") -> Iterator[Result]:
    """The results of a whole run, step by step, or of the steps of one command."""
    leave = Leave.of(
        EVERYTHING,
        joints=table.joints,
        max_speed=FASTEST,
        workspace=dict.fromkeys(range(1, table.joints + 1), WORKSPACE),
    )
    tester = Tester(Line(MemoryLink(peer, clock), clock), table, leave=leave)
    for step in tester.steps():
        if not only or (step.command is not None and step.command.name == only):
            yield from tester.results(step)
