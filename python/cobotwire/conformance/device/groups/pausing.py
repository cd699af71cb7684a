"""A pause holds the arm on its way; resuming takes it to its target."""

from __future__ import annotations

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.motion import ARRIVES, UNDER_WAY, under_way
from cobotwire.conformance.device.mover import POLL, Mover, off_by
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import flag_text
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Table

PAUSES = TestCase(
    "pauses", "A pause holds the arm where it is, short of its target, and is reported."
)


def _pauses(table: Table, command: Command) -> bool:
    """Return whether a command sets what the query for a pause reports, and another resets it."""
    query = table.find_role("paused")
    return (
        query is not None
        and command.safety == "motion"
        and not command.request[0].fields
        and command is _setter(table, query, 1)
        and _setter(table, query, 0) is not None
    )


def _setter(table: Table, query: Command, value: int) -> Command | None:
    for command in table.commands:
        back = command.read_by
        if back and back.query == query.name and any(v == value for _, v in back.fields):
            return command
    return None


def _pause(probe: Probe) -> None:
    """Pause on the way, and resume."""
    mover, device = Mover(probe), probe.device
    resume = _setter(device.table, device.table.in_role("paused"), 0)
    if resume is None:
        raise NotSupported("no command resumes")
    mover.go(mover.pose(0))
    target = mover.pose(1)
    device.request(mover.to(target, 1))
    mover.rest(UNDER_WAY)
    if not under_way(probe, mover, target, PAUSES):
        return
    request_change(probe, probe.command.request_type())
    # The arm slows down first.
    mover.rest(2 * POLL)
    paused = mover.angles()
    mover.rest(4 * UNDER_WAY)
    moved = off_by(mover.angles(), paused, mover.tolerance, "was at")
    reason = f"after {probe.command.name}, expected the arm to stay"
    probe.expect(PAUSES, not moved, f"{reason}; {'; '.join(moved)}")
    _expect_reported(probe, True)
    short = bool(off_by(paused, target, mover.tolerance))
    probe.expect(PAUSES, short, f"{reason} on its way, but it is at its target")
    request_change(probe, resume.request_type())
    mover.wait()
    wrong = mover.differences(target)
    reason = f"{resume.name} after {probe.command.name}, expected the arm to go on to its target"
    probe.expect(ARRIVES, not wrong, f"{reason}; {'; '.join(wrong)}")
    _expect_reported(probe, False)


def _expect_reported(probe: Probe, paused: bool) -> None:
    """Expect the query to report whether the arm is paused, long after it is."""
    query = probe.device.table.in_role("paused")
    reported = probe.device.is_set(query.request_type())
    expected = f"after {probe.command.name}, {query.name}: expected {flag_text(query, paused)}"
    reason = f"{expected}; came {flag_text(query, reported)}"
    probe.expect(PAUSES, reported is paused, reason)


PAUSING = Group(
    "pauses",
    (PAUSES, ARRIVES, *AFTER_CHANGE),
    _pause,
    _pauses,
    sends="A slow motion, the pause on its way, and the command that resumes.",
    subject="the command that pauses, if another one resumes",
)
