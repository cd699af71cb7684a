"""Lists to which values are appended: the values are counted, and read in their order.

Reading a value removes it. Nothing moves. If no query counts a list, the test empties it first, and
its old values may be lost.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

from cobotwire.conformance.device.device import Device, NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE_OR_REPLY, request_change
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.read_back import EXACT
from cobotwire.conformance.device.requests import as_row, gentle_values, revealing
from cobotwire.conformance.device.selection import does, first
from cobotwire.conformance.samples.physical import takes_whole
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.effects import Lists, empty_value
from cobotwire.protocol.fields import Field, named_fields
from cobotwire.protocol.table import Command, Table

IN_ORDER = TestCase(
    "points-in-order",
    "Points that were added are counted, and read in the order in which they were added.",
)

CLEARED = TestCase("list-cleared", "A list that was cleared holds nothing.")

# How many points are added, and how many old points of the device are put back at most.
ADDED, MOST_KEPT = 3, 50
# If nothing else reports that a list is empty, this many zeros in a row mean that it is.
ZEROS = 3


class _List(NamedTuple):
    """The commands that append to a list, take its first point, count it, and report it empty."""

    add: Command
    argument: Field
    take: Command | None
    counter: Command | None
    empty: Command | None

    def request(self, point: tuple[float, ...]) -> Any:
        """Return the request that appends a point."""
        value = point if self.argument.many else point[0]
        arguments = gentle_values(self.add.request[0]) | {self.argument.name: value}
        return self.add.request_type.from_fields(arguments)

    @property
    def points(self) -> list[tuple[float, ...]]:
        """Points that differ in each number."""
        shown = self.argument if self.take is None else self.take.reply[0].fields[-1]
        pairs = list(zip(self.argument.cases[0].numbers, shown.cases[0].numbers))
        rows = revealing([pairs], [(0,) * len(pairs)])
        return [tuple(as_row(row[0])) for row in rows[:ADDED]]


def _list(table: Table, state: str) -> _List | None:
    """Return the commands of a list to which numbers can be appended; None: nothing reports it."""
    wanted = ({"append": True}, {"take": "first"}, {"report": "count"}, {"report": "empty"})
    add, take, counter, empty = (first(table, does(Lists, state=state, **each)) for each in wanted)
    appends = None if add is None else does(Lists)(table, add)
    if add is None or appends is None:
        return None
    argument = named_fields(add.request)[appends.append][0]
    ends = take is not None and does(Lists, empty="zeros")(table, take)
    shown = counter or ends or (empty and take is None)
    return (
        _List(add, argument, take, counter, empty) if shown and not takes_whole(argument) else None
    )


def _of(**wanted: object) -> Callable[[Table, Command], _List | None]:
    """Return a function that returns the list on which a command has the wanted effect."""

    def found(table: Table, command: Command) -> _List | None:
        effect = does(Lists, **wanted)(table, command)
        return _list(table, effect.state) if effect else None

    return found


appended, taken, cleared = _of(append=True), _of(take="first"), _of(clear="all")


def _counted(table: Table, command: Command) -> _List | None:
    points = appended(table, command)
    return points if points and points.take and points.counter else None


def _uncounted(table: Table, command: Command) -> _List | None:
    return None if _counted(table, command) else appended(table, command)


def _in_order(probe: Probe, points: _List) -> None:
    """Take the old points out, add new ones, read these, and put the old ones back."""
    take, count = points.take, _count(probe.device, points)
    if take is not None:
        own = _take_own(probe, points, take, count)
        probe.device.restore_after_body[probe.command.name] = partial(_restore, probe, points, own)
        count = 0
    _expect_count(probe, points, count)
    for number, point in enumerate(points.points, 1):
        request_change(probe, points.request(point))
        _expect_count(probe, points, count + number)
    if take is None:
        return
    for number, point in enumerate(points.points, 1):
        received = _take(probe, take)
        same = all(abs(one - other) <= EXACT for one, other in zip(point, received))
        reason = f"{take.name}: expected {point}, which was added as number {number}"
        reason += f"; received {received}"
        probe.expect(IN_ORDER, same, reason)
        _expect_count(probe, points, len(points.points) - number)


def _count(device: Device, points: _List) -> int:
    """Return how many points there are; 0 if no query counts them."""
    query = points.counter
    if query is None:
        return 0
    return int(device.require(query.request_type()).fields[query.reply[0].fields[-1].name])


def _take_own(probe: Probe, points: _List, take: Command, count: int) -> list[tuple[float, ...]]:
    """Take all points from the list and return them; if no query counts them, stop at zeros."""
    own: list[tuple[float, ...]] = []
    while len(own) < (count if points.counter else ZEROS) or (
        not points.counter and any(map(any, own[-ZEROS:]))
    ):
        if max(count, len(own)) > MOST_KEPT:
            raise NotSupported(f"more than {MOST_KEPT} points are recorded, which would be lost")
        own.append(_take(probe, take))
    return own if points.counter else own[:-ZEROS]


def _expect_count(probe: Probe, points: _List, count: int, case: TestCase = IN_ORDER) -> None:
    """Expect the number of points, and the report whether there are any."""
    device = probe.device
    if points.counter is not None:
        received = _count(device, points)
        probe.expect(
            case, received == count, f"{points.counter.name}: expected {count}; received {received}"
        )
    if points.empty is not None:
        filled, when = points.empty.request_type(), f", with {count} points"
        right = (count == 0) == bool(empty_value(points.empty.reply[0].fields[-1]))
        probe.expect_flag(case, filled, right, when=when)


def _take(probe: Probe, take: Command) -> tuple[float, ...]:
    response = probe.device.request(take.request_type())
    if response.valid is None or response.valid.message is None:
        for reply in response.replies:
            reason = f"{take.name}: expected legal values; {reply.error}"
            probe.expect(IN_ORDER, reply.error is None, reason)
        raise NotSupported(f"{take.name} reports nothing")
    return as_row(response.valid.message.fields[take.reply[0].fields[-1].name])


def _restore(probe: Probe, points: _List, own: list[tuple[float, ...]]) -> None:
    assert points.take is not None, "without it nothing was taken"
    left = _count(probe.device, points) if points.counter else ADDED
    for _ in range(min(left, ADDED)):
        probe.device.request(points.take.request_type())
    for point in own:
        probe.device.request(points.request(point))


def _clear(probe: Probe, points: _List) -> None:
    """Add a point, and clear the list."""
    probe.device.request(points.request(points.points[0]))
    request_change(probe, probe.command.request_type())
    _expect_count(probe, points, 0, CLEARED)
    if points.take is not None:
        received = _take(probe, points.take)
        reason = f"{points.take.name}: expected zeros from an empty list; received {received}"
        probe.expect(CLEARED, not any(received), reason)


RECORDED = Group(
    "recorded points",
    (IN_ORDER, *AFTER_CHANGE_OR_REPLY),
    *for_found(_counted, _in_order),
    sends="Points that differ in each number, one by one; the queries that count and read them.",
    subject="the command that adds a point, if another one reads it and one counts them",
)
UNCOUNTED = Group(
    "listed values",
    (IN_ORDER, *AFTER_CHANGE_OR_REPLY),
    *for_found(_uncounted, _in_order),
    frozenset({"irreversible"}),
    sends="Values that differ in each number, one by one; then commands that read or count them.",
    subject="each other command that appends to a list, if another one reads or reports it",
)
CLEARS = Group(
    "cleared lists",
    (CLEARED, *AFTER_CHANGE_OR_REPLY),
    *for_found(cleared, _clear),
    frozenset({"irreversible"}),
    sends="A value to append, the command, then the queries that read the list or report on it.",
    subject="each command that clears a list, if values can be added and read or counted",
)
