"""Points that are recorded one by one: they are counted, and read in the order of recording.

Reading a point removes it. Nothing moves.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import as_row, flag_text, request_of, revealing, units
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Field, Table

IN_ORDER = TestCase(
    "points-in-order",
    "Points that were added are counted, and read in the order in which they were added.",
)

# How many points are added; how many of the device's own are kept at most, to be added again.
ADDED, MOST_KEPT = 3, 50
# Both values are multiples of the wire's step, so only floating-point errors are tolerated.
EXACT = 1e-6


def _adds_points(table: Table, command: Command) -> bool:
    """Return whether a command adds a row that another one reads and removes, and one counts."""
    return (
        command.safety == "setting"
        and not command.requires_reply
        and _row(command.request[0].fields) is not None
        and _taker(table, command) is not None
        and _counter(table, command) is not None
    )


def _row(fields: Sequence[Field]) -> Field | None:
    """Return the only field, if it is a row of numbers."""
    return fields[0] if len(fields) == 1 and fields[0].many else None


def _bare(table: Table, command: Command, safety: str) -> list[Command]:
    """Return the commands of the same family that take no arguments and reply with one field."""
    return [
        other
        for other in table.commands
        if other.family == command.family
        and other.safety == safety
        and other.requires_reply
        and not other.request[0].fields
        and other.reply
        and len(other.reply[0].fields) == 1
    ]


def _taker(table: Table, command: Command) -> Command | None:
    """Return the command that reads and removes a row of the same units."""
    added = _row(command.request[0].fields)
    for other in _bare(table, command, "setting"):
        taken = _row(other.reply[0].fields)
        if added and taken and units(added.cases[0].numbers) == units(taken.cases[0].numbers):
            return other
    return None


def _counter(table: Table, command: Command) -> Command | None:
    """Return the query that counts the points."""
    for query in _bare(table, command, "query"):
        [field] = query.reply[0].fields
        if not field.many and not field.choices and not field.cases[0].numbers[0].unit:
            return query
    return None


def _in_order(probe: Probe) -> None:
    """Take the points that are there, add some, read them, and add the first ones again."""
    table, command = probe.device.table, probe.command
    taker, counter = _taker(table, command), _counter(table, command)
    assert taker is not None, "the group selects editions with it"
    assert counter is not None, "the group selects editions with it"
    own = _take_all(probe, taker, counter)
    probe.device.restore_after_body[command.name] = partial(_restore, probe, taker, counter, own)
    points = _points(command, taker)
    _expect_count(probe, counter, 0)
    for count, point in enumerate(points, 1):
        request_change(probe, request_of(command, point))
        _expect_count(probe, counter, count)
    for taken, point in enumerate(points, 1):
        came = _take(probe, taker)
        same = all(abs(one - other) <= EXACT for one, other in zip(point, came))
        reason = f"{taker.name}: expected {point}, which was added as number {taken}; came {came}"
        probe.expect(IN_ORDER, same, reason)
        _expect_count(probe, counter, len(points) - taken)


def _points(command: Command, taker: Command) -> list[tuple[float, ...]]:
    added, taken = command.request[0].fields[0], taker.reply[0].fields[0]
    pairs = list(zip(added.cases[0].numbers, taken.cases[0].numbers))
    samples = revealing([pairs], [(0,) * len(pairs)])
    return [sample[0] for sample in samples[:ADDED]]


def _expect_count(probe: Probe, counter: Command, count: int) -> None:
    """Expect the number of points, and what other queries report about them."""
    came = probe.device.require(counter.request_type()).result
    probe.expect(IN_ORDER, came == count, f"{counter.name}: expected {count}; came {came}")
    for query in _bare(probe.device.table, probe.command, "query"):
        if len(query.reply[0].fields[0].choices) == 2:
            filled = probe.device.is_set(query.request_type())
            expected = f"{query.name}: expected {flag_text(query, count > 0)}, with {count} points"
            reason = f"{expected}; came {flag_text(query, filled)}"
            probe.expect(IN_ORDER, filled is (count > 0), reason)


def _take_all(probe: Probe, taker: Command, counter: Command) -> list[tuple[float, ...]]:
    """Return the points that are there, which no longer are.

    Raises:
        NotSupported: there are too many to add them again.
    """
    count = probe.device.require(counter.request_type()).result
    if count > MOST_KEPT:
        raise NotSupported(f"{count} points are recorded, which would be lost")
    return [_take(probe, taker) for _ in range(count)]


def _take(probe: Probe, taker: Command) -> tuple[float, ...]:
    response = probe.device.request(taker.request_type())
    if response.valid is None or response.valid.message is None:
        for reply in response.replies:
            reason = f"{taker.name}: expected legal values; {reply.error}"
            probe.expect(IN_ORDER, reply.error is None, reason)
        raise NotSupported(f"{taker.name} reports nothing")
    return as_row(response.valid.message.result)


def _restore(probe: Probe, taker: Command, counter: Command, own: list[Any]) -> None:
    left = probe.device.read(counter.request_type())
    for _ in range(0 if left is None else min(left.result, ADDED)):
        probe.device.request(taker.request_type())
    for point in own:
        probe.device.request(request_of(probe.command, point))


RECORDED = Group(
    "recorded points",
    (IN_ORDER, *AFTER_CHANGE),
    _in_order,
    _adds_points,
    sends="Points that differ in each part, one by one; the number of points; each point.",
    subject="the command that adds a point, if another one reads it and one counts them",
)
