"""The gripper opens and closes, and reports that it moves."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.motion import (
    ARRIVED,
    ARRIVES,
    MOVING,
    NEAR,
    Motion,
    expect_on_the_way,
    expect_rest,
    is_replayed,
)
from cobotwire.conformance.device.mover import Mover, Pose
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, settings_of
from cobotwire.conformance.device.requests import as_row, request_of
from cobotwire.conformance.suite import Group
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table

# Slow enough to be reported as moving, in percent of the fastest.
SLOW = 20
# The names of the gripper's states.
OPEN, CLOSE = "OPEN", "CLOSE"


def _has_own_moving(table: Table, command: Command) -> bool:
    """Return whether a query of the command's family reports that what it moves is moving."""
    return is_replayed(table, command) and _moving(table, command) is not None


def _reports_moving(probe: Probe) -> None:
    """Expect the query to report motion on the way, and no motion at the target."""
    mover, motion = Mover(probe), settings_of(probe.device.table, probe.command)[-1]
    moving, position = _moving(probe.device.table, probe.command), motion.query.request_type()
    assert moving is not None
    reported, argument = motion.pairs[0]
    observed = []

    def place() -> Pose:
        return as_row(probe.device.require(position).fields[reported])

    for target in _ends(probe, motion, position, min(SLOW, mover.speed)):
        start, end = place(), as_row(target.fields[argument])
        probe.device.request(target)
        way = Motion(place, start, end, NEAR["percent"])
        observed.append(expect_on_the_way(probe, moving, way))
        mover.settle(lambda: probe.device.read(position))
        expect_rest(probe, moving)
    if not any(observed):
        probe.not_timed(MOVING, ARRIVED)


def _ends(probe: Probe, motion: Setting, position: Request[Any], speed: int) -> list[Request[Any]]:
    """Return requests for two values apart from each other, the one further away first."""
    old = probe.device.require(position)
    reported, argument = motion.pairs[0]
    now = old.fields[reported]
    between = motion.samples(position, old, speed)[:2]
    return sorted(between, key=lambda sample: -_distance(sample.fields[argument], now))


def _distance(value: Any, other: Any) -> float:
    """Return how far two values are apart; of two rows, the numbers that are furthest apart."""
    if isinstance(value, tuple):
        return max(map(_distance, value, other))
    return abs(float(value) - float(other))


def _moving(table: Table, command: Command) -> Command | None:
    """Return the query of the family that has the same field as the arm's own query."""
    arm = table.find_role("moving")
    names = [field.name for field in arm.reply[0].fields] if arm else []
    for query in _queries(table, command):
        if query is not arm and [field.name for field in query.reply[0].fields] == names:
            return query
    return None


def opens(table: Table, command: Command) -> bool:
    """Return whether a command opens what a query of its family reports in percent."""
    labels = command.request[0].fields[0].labels if command.request[0].fields else ()
    return {OPEN, CLOSE} <= set(labels) and _opening(table, command) is not None


def _open_and_close(probe: Probe) -> None:
    """Expect open to be wider than closed."""
    mover, query = Mover(probe), _opening(probe.device.table, probe.command)
    assert query is not None
    position = query.request_type()
    state = probe.command.request[-1].fields[0]
    wide = {}
    for label in (OPEN, CLOSE, OPEN, CLOSE):
        choice = state.choices[state.labels.index(label)]
        request_change(probe, request_of(probe.command, choice, mover.speed))
        mover.settle(lambda: probe.device.read(position))
        wide[label] = probe.device.require(position).result
    wider = wide[OPEN] > wide[CLOSE]
    probe.expect(ARRIVES, wider, f"{probe.command.name}: expected open to be wider; came {wide}")


def _opening(table: Table, command: Command) -> Command | None:
    for query in _queries(table, command):
        if query.reply[0].fields[0].cases[0].numbers[0].unit == "percent":
            return query
    return None


def _queries(table: Table, command: Command) -> list[Command]:
    """Return the queries of a command's family that have a framed reply."""
    family = [query for query in table.commands if query.family == command.family]
    return [query for query in family if query.safety == "query" and query.reply]


GRIPPER_MOVES = Group(
    "gripper moves",
    (MOVING,),
    _reports_moving,
    _has_own_moving,
    sends="Two positions of the gripper; whether it moves is read on the way and at the end.",
    subject="each motion of a gripper that a query reports as moving",
)
GRIPPER_OPENS = Group(
    "gripper opens",
    (ARRIVES, *AFTER_CHANGE),
    _open_and_close,
    opens,
    sends="Open and close, twice; the opening is read after each.",
    subject="each command that opens and closes a gripper",
)
