"""Requests of different commands in one write: all are replied to, in their order."""

from __future__ import annotations

from cobotwire.conformance.device.groups.queries import is_query, sample_of
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.hex_text import shown
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Table

IN_ORDER = TestCase(
    "replies-in-order",
    "Requests of different commands in one write are replied to in their order.",
)


def _can_be_told_apart(table: Table, command: Command) -> bool:
    """Return whether a query has a framed reply that names the command."""
    named = table.frame.reply_has_id and is_query(table, command) and bool(command.reply)
    return named and _other(table, command) is not None


def _other(table: Table, command: Command) -> Command | None:
    """Return another query without arguments, which is not slow and which the device has."""
    found = [
        c
        for c in table.commands
        if is_query(table, c) and c.reply and not c.request[0].fields and c.id != command.id
    ]
    return min(found, key=lambda c: c.deadline_ms, default=None)


def _ordered(probe: Probe) -> None:
    """Send the query before another one, and after it."""
    device, command = probe.device, probe.command
    other = _other(device.table, command)
    assert other is not None, "the group selects commands with another query"
    first = sample_of(device, command)
    # A query that has no reply fails elsewhere.
    device.require(first)
    mine, theirs = (device.requester.prepare(r) for r in (first, other.request_type()))
    for pair in ((mine, theirs), (theirs, mine)):
        names = " and ".join(each.command.name for each in pair)
        start = device.connection.mark
        data = pair[0].frame + pair[1].frame
        response = device.count(device.requester.send_instead(mine, data, names))
        if not response.replies or not response.others:
            deadline = max(mine.command.deadline_ms, theirs.command.deadline_ms) / 1000
            device.requester.listen(response, deadline)
        came = device.connection.received_since(start)
        right = [each.command.id for each in pair]
        frames = [reply.data for reply in response.replies] + [f.data for f in response.others]
        frames.sort(key=came.find)
        ids = [device.table.frame.read_id(frame) for frame in frames]
        reason = f"{names} in one write: expected a reply to each, in this order; came "
        reason += "; ".join(map(shown, frames)) or "nothing"
        if ids == right[::-1]:
            reason += ": in the other order"
        elif ids == right[:1]:
            reason += f": {pair[1].command.name} had no reply"
        probe.expect(IN_ORDER, ids == right, reason)


ORDERED = Group(
    "requests of two commands",
    (IN_ORDER,),
    _ordered,
    _can_be_told_apart,
    frozenset({"malformed"}),
    sends="The query and another one in one write, in both orders.",
    subject="each query with a framed reply that has an id",
)
