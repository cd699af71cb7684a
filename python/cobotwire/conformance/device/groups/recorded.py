"""Points that are recorded one by one: they are counted, and read in the order of recording.

Reading a point removes it. Nothing moves.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.probe import Probe, for_rows
from cobotwire.conformance.device.requests import as_row, request_of, revealing
from cobotwire.conformance.device.selection import does, first
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.effects import Lists
from cobotwire.protocol.table import Command, Table

IN_ORDER = TestCase(
    "points-in-order",
    "Points that were added are counted, and read in the order in which they were added.",
)

# How many points are added; how many of the device's own are kept at most, to be added again.
ADDED, MOST_KEPT = 3, 50
# Both values are multiples of the wire's step, so only floating-point errors are tolerated.
EXACT = 1e-6


class _List(NamedTuple):
    """The commands of a list: what reads and removes the first point, and what reports on it."""

    take: Command
    counter: Command
    empty: Command | None


def _list(table: Table, command: Command) -> _List | None:
    """Return the commands of the list to which a command appends."""
    appends = does(Lists, append=True)(table, command)
    state = "" if appends is None else appends.state
    take, counter, empty = (
        first(table, does(Lists, state=state, **wanted))
        for wanted in ({"take": "first"}, {"report": "count"}, {"report": "empty"})
    )
    return None if take is None or counter is None else _List(take, counter, empty)


def _in_order(probe: Probe, points: _List) -> None:
    """Take the points that are there, add some, read them, and add the first ones again."""
    device, command, take = probe.device, probe.command, points.take
    count = device.require(points.counter.request_type()).result
    if count > MOST_KEPT:
        raise NotSupported(f"{count} points are recorded, which would be lost")
    own = [_take(probe, take) for _ in range(count)]
    device.restore_after_body[command.name] = partial(_restore, probe, points, own)
    numbers = (f.cases[0].numbers for f in (command.request[0].fields[0], take.reply[0].fields[0]))
    pairs = list(zip(*numbers))
    added = [sample[0] for sample in revealing([pairs], [(0,) * len(pairs)])[:ADDED]]
    _expect_count(probe, points, 0)
    for number, point in enumerate(added, 1):
        request_change(probe, request_of(command, point))
        _expect_count(probe, points, number)
    for number, point in enumerate(added, 1):
        came = _take(probe, take)
        same = all(abs(one - other) <= EXACT for one, other in zip(point, came))
        reason = f"{take.name}: expected {point}, which was added as number {number}; came {came}"
        probe.expect(IN_ORDER, same, reason)
        _expect_count(probe, points, len(added) - number)


def _expect_count(probe: Probe, points: _List, count: int) -> None:
    """Expect the number of points, and the report whether there are any."""
    came = probe.device.require(points.counter.request_type()).result
    probe.expect(IN_ORDER, came == count, f"{points.counter.name}: expected {count}; came {came}")
    if points.empty is not None:
        filled, when = points.empty.request_type(), f", with {count} points"
        probe.expect_flag(IN_ORDER, filled, count > 0, when=when)


def _take(probe: Probe, take: Command) -> tuple[float, ...]:
    response = probe.device.request(take.request_type())
    if response.valid is None or response.valid.message is None:
        for reply in response.replies:
            reason = f"{take.name}: expected legal values; {reply.error}"
            probe.expect(IN_ORDER, reply.error is None, reason)
        raise NotSupported(f"{take.name} reports nothing")
    return as_row(response.valid.message.result)


def _restore(probe: Probe, points: _List, own: list[tuple[float, ...]]) -> None:
    left = probe.device.read(points.counter.request_type())
    for _ in range(0 if left is None else min(left.result, ADDED)):
        probe.device.request(points.take.request_type())
    for point in own:
        probe.device.request(request_of(probe.command, point))


RECORDED = Group(
    "recorded points",
    (IN_ORDER, *AFTER_CHANGE),
    *for_rows(_list, _in_order),
    sends="Points that differ in each part, one by one; the number of points; each point.",
    subject="the command that adds a point, if another one reads it and one counts them",
)
