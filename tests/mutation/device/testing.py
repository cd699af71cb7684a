"""Run the device tester, with all permissions, on a peer in memory and in stepped time."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

from cobotwire import editions
from cobotwire.cli.shared.subject_connection import Lacking
from cobotwire.conformance.device import ALL_PERMISSIONS
from cobotwire.conformance.report import Cause, Result, Verdict
from cobotwire.protocol.addresses import devices_of
from cobotwire.protocol.table import Table
from cobotwire.simulator.arm import SimulatedArm
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.peer import Peer
from conformance.device.testing import on_peer, permissions

# A simulated arm cannot be damaged.
FASTEST = 100
QUERY_REPLIED = "query-replied"


class Complaint(NamedTuple):
    """A test case that a device fails on a command, or on the transport as a whole, and why."""

    command: str
    case: str
    reason: str

    def __str__(self) -> str:
        return ": ".join(part for part in self if part)


def complaints(
    table: Table, peer: Peer, clock: SteppedClock, only: str = "", address: str | None = None
) -> Iterator[Complaint]:
    """Yield the failures as the tester finds them; ``only`` restricts the run to one command.

    ``address`` is one of :func:`tested_addresses`; left out: the first.

    A run that ends early is a complaint too: its report says that the device stopped replying.
    """
    address = address or tested_addresses(table)[0]
    # A command that the simulated arm reports as not supported is not a failure.
    lacking = on_correct_arm(table, address).lacking
    for result in _results(table, peer, clock, only, address, lacking):
        if result.verdict is Verdict.FAIL:
            yield Complaint(result.command, result.case, result.reason)
        elif result.cause is Cause.RUN_ENDED:
            yield Complaint("", "run ended", result.reason)


class OnCorrectArm(NamedTuple):
    """What a whole run on the correct arm shows.

    ``lacking`` are the commands that the arm does not support, with the reason it states: the
    coordinates of an unknown geometry. ``tested`` are the commands on which a test case passed,
    ``replied`` the queries that had replies.
    """

    lacking: dict[str, str]
    tested: frozenset[str]
    replied: frozenset[str]


@cache
def _of_edition(edition: str, address: str | None) -> OnCorrectArm:
    table = editions.load(edition).TABLE
    clock, stated = SteppedClock(), Lacking(table)
    arm = SimulatedArm(table, clock=clock, on_note=stated.note)
    passed = [
        result
        for result in _results(table, arm, clock, "", address, stated.reasons)
        if result.verdict is Verdict.PASS
    ]
    replied = (result.command for result in passed if result.case == QUERY_REPLIED)
    tested = (result.command for result in passed)
    return OnCorrectArm(stated.reasons, frozenset(tested), frozenset(replied))


def on_correct_arm(table: Table, address: str | None = None) -> OnCorrectArm:
    """Return what a whole run on the correct arm shows.

    If the geometry is known, the arm supports all commands, and nothing is run.
    """
    if table.robot.geometry is not None:
        every = frozenset(command.name for command in table.commands)
        return OnCorrectArm({}, every, every)
    return _of_edition(table.edition, address or tested_addresses(table)[0])


def lacking(table: Table, command: str) -> str:
    """Return why the simulated arm lacks a command at all addresses; empty if one has it."""
    arms = [on_correct_arm(table, each) for each in tested_addresses(table)]
    if any(command in arm.replied for arm in arms):
        return ""
    return next((arm.lacking[command] for arm in arms if command in arm.lacking), "")


def is_tested(table: Table, command: str) -> bool:
    """Return whether a test case passes on a command of the correct arm."""
    return any(command in on_correct_arm(table, each).tested for each in tested_addresses(table))


def tested_addresses(table: Table) -> tuple[str | None, ...]:
    """Return the addresses of the devices that are tested; None if frames have none.

    Each belongs to a single device, because any device may reply to a request to all of them. Of
    devices with the same number of joints, only the first is tested.
    """
    devices = {device.joints: device.name for device in reversed(devices_of(table))}
    return tuple(reversed(devices.values())) or (None,)


def _results(
    table: Table,
    peer: Peer,
    clock: SteppedClock,
    only: str,
    address: str | None,
    lacking: dict[str, str],
) -> Iterator[Result]:
    allowed = permissions(*ALL_PERMISSIONS, joints=table.joints, max_speed=FASTEST)
    tester = on_peer(peer, clock, table, permissions=allowed, address=address, lacking=lacking)
    for step in tester.steps():
        if not only or (step.command is not None and step.command.name == only):
            yield from tester.results(step)
