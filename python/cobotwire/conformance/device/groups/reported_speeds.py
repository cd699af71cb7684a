"""The speeds that a query reports are those of the joints: zero at rest, and right on the way."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.mover import Mover, Pose
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import as_row
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Field, Table

REPORTED = TestCase(
    "speeds-reported",
    "The speeds that a query reports are near zero at rest; on the way they fit the angles.",
)

STEPS, TURNS = "step_per_second", "revolution_per_minute"
# One revolution per minute, in degrees per second.
TURN = 6.0
# The angles are read this long before and after the speeds, in seconds.
BESIDE = 0.1
# A joint is checked if it turns at least this far between the readings of its angle, in degrees.
LEAST = 0.4
# How many times too large or too small a speed may be: an arm speeds up and slows down.
APART = 3.0
# The speed of a joint at rest may be this share of the fastest one on the way: sensors have noise.
AT_REST = 0.1
# The motion is slow, so that it lasts longer than the readings; in percent of the fastest.
SLOW = 5


def _reports_speeds(table: Table, command: Command) -> bool:
    """Return whether a query reports the speed of each joint in a unit with a known size."""
    is_plain = command.safety == "query" and bool(command.reply) and not command.request[0].fields
    moves = table.find_role("joint targets") is not None and table.find_role("joints") is not None
    return is_plain and moves and _field(table, command) is not None


def _field(table: Table, command: Command) -> Field | None:
    """Return the field with a speed for each joint; after the joints, it may have others."""
    known = (STEPS, TURNS) if table.robot.encoders else (TURNS,)
    for field in command.reply[0].fields:
        numbers = field.cases[0].numbers
        if field.many and len(numbers) >= table.joints and numbers[0].unit in known:
            return field
    return None


def _reported(probe: Probe) -> None:
    """Move some joints after others: each takes part in other motions, so none is mistaken."""
    mover, query = Mover(probe), probe.command.request_type()
    start, other = mover.pose(0), mover.pose(1)
    here = start
    mover.go(here)
    for share in (1, 2, 4):
        moved = [at for at in range(len(here)) if at + 1 & share]
        target = tuple(
            (start if here[at] == other[at] else other)[at] if at in moved else here[at]
            for at in range(len(here))
        )
        probe.device.request(mover.to(target, min(SLOW, mover.speed)))
        mover.rest(BESIDE)
        fastest = _expect_on_the_way(probe, mover, query, target, moved)
        mover.wait()
        near = max(_unit(probe), AT_REST * fastest)
        _expect_rest(probe, _speeds(probe, query), near, "at rest")
        here = target


def _expect_on_the_way(
    probe: Probe, mover: Mover, query: Request[Any], target: Pose, moved: list[int]
) -> float:
    """Compare the speeds with the angles before and after; return how fast the fastest turned."""
    began, before = probe.device.connection.now, mover.angles()
    mover.rest(BESIDE)
    speeds = _speeds(probe, query)
    mover.rest(BESIDE)
    after = mover.angles()
    took = probe.device.connection.now - began
    turned = [abs(b - a) / took for a, b in zip(before, after)]
    under_way = [
        at
        for at in moved
        if turned[at] * took >= LEAST and abs(after[at] - target[at]) > mover.tolerance
    ]
    wrong = [
        f"joint {at + 1}: {abs(speeds[at]):.3g}, but it turned {turned[at]:.3g} degrees in a second"
        for at in under_way
        if not turned[at] / APART <= abs(speeds[at]) <= APART * turned[at]
    ]
    reason = f"{probe.command.name}, in degrees per second on the way: {'; '.join(wrong)}"
    probe.expect(REPORTED, not wrong, reason)
    held = tuple(0.0 if at in moved else speed for at, speed in enumerate(speeds))
    near = max(_unit(probe), AT_REST * max(turned))
    _expect_rest(probe, held, near, "of joints that were held")
    return max(turned)


def _expect_rest(probe: Probe, speeds: Pose, near: float, when: str) -> None:
    """Expect that the speeds are near zero."""
    wrong = [
        f"joint {joint}: {speed:.3g}" for joint, speed in enumerate(speeds, 1) if abs(speed) > near
    ]
    reason = f"{probe.command.name}, in degrees per second {when}: {'; '.join(wrong)}"
    probe.expect(REPORTED, not wrong, reason)


def _speeds(probe: Probe, query: Request[Any]) -> Pose:
    """Return the speed of each joint, in degrees per second.

    Raises:
        NotSupported: no valid reply came.
    """
    field = _field(probe.device.table, probe.command)
    valid = probe.device.request(query).valid
    if valid is None or valid.decoded is None or field is None:
        raise NotSupported(f"{probe.command.name} reports nothing")
    row = as_row(valid.decoded.fields[field.name])[: probe.device.joints]
    return tuple(_unit(probe) * value for value in row)


def _unit(probe: Probe) -> float:
    """Return how many degrees per second one unit of the reported speeds is."""
    table = probe.device.table
    field, encoders = _field(table, probe.command), table.robot.encoders
    in_steps = field is not None and field.cases[0].numbers[0].unit == STEPS
    return encoders.degrees if in_steps and encoders is not None else TURN


REPORTED_SPEEDS = Group(
    "reported speeds",
    (REPORTED,),
    _reported,
    _reports_speeds,
    frozenset({"motion"}),
    sends="The query on the way of three slow motions of some of the joints, and at rest.",
    subject="each query of the joints' speeds, if the edition says how large their unit is",
)
