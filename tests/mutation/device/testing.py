"""Run the device tester, with all permissions, on a peer in memory and in stepped time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from cobotwire.conformance.device import ALL_PERMISSIONS, DeviceConnection, Permissions, Tester
from cobotwire.conformance.report import Result, Verdict
from cobotwire.protocol.table import Table
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.simulator.peer import Peer

# Each joint may move this far (degrees), at full speed: a simulated arm cannot be damaged.
WORKSPACE = (-60.0, 60.0)
FASTEST = 100


class Complaint(NamedTuple):
    """A test case that a device fails on a command, or on the line as a whole, and why."""

    command: str
    case: str
    reason: str

    def __str__(self) -> str:
        return ": ".join(part for part in self if part)


def complaints(
    table: Table, peer: Peer, clock: SteppedClock, only: str = ""
) -> Iterator[Complaint]:
    """Yield the failures as the tester finds them; ``only`` restricts the run to one command."""
    for result in results(table, peer, clock, only):
        if result.verdict is Verdict.FAIL:
            yield Complaint(result.command, result.case, result.reason)


def results(table: Table, peer: Peer, clock: SteppedClock, only: str = "") -> Iterator[Result]:
    """Yield the results of a whole run step by step, or of the steps of one command."""
    permissions = Permissions.of(
        ALL_PERMISSIONS,
        joints=table.joints,
        max_speed=FASTEST,
        workspace=dict.fromkeys(range(1, table.joints + 1), WORKSPACE),
    )
    tester = Tester(
        DeviceConnection(MemoryTransport(peer, clock), clock), table, permissions=permissions
    )
    for step in tester.steps():
        if not only or (step.command is not None and step.command.name == only):
            yield from tester.results(step)
