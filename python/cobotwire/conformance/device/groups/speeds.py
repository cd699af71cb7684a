"""A higher speed moves the arm faster."""

from __future__ import annotations

from typing import NamedTuple

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.mover import Mover, Pose
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Table

FASTER = TestCase("faster", "A higher speed moves the arm faster.")

# The fast speed is SHARE times the slow one; the slow motion must take at least LONGER times as
# long, not SHARE times: on a short distance, an accelerating arm does not reach its full speed.
SHARE, LONGER = 10, 1.25
# The share of the distance between two poses that is timed; and the time limit, in seconds.
WAY, LONGEST = 0.5, 20.0
POLL = 0.005


def _has_speed(table: Table, command: Command) -> bool:
    """Return whether a command moves all joints at a speed."""
    fields = command.request[0].fields if command.role == "joint targets" else ()
    return any(field.cases[0].numbers[0].unit == "percent" for field in fields)


def _speeds(probe: Probe) -> None:
    """Time the first half of the same motion at two speeds."""
    mover = Mover(probe)
    slow = max(1, mover.speed // SHARE)
    if slow == mover.speed:
        raise NotSupported("the speed limit is 1 percent, and no speed is lower")
    start, target = mover.pose(1), mover.pose(0)
    took = {}
    for speed in (mover.speed, slow):
        mover.go(start)
        took[speed] = _seconds(mover, start, target, speed)
        mover.wait()
    fast, other = took[mover.speed], took[slow]
    reason = (
        f"{probe.command.name}: half of the way took {other.least:.3f} to {other.most:.3f} s at "
        f"speed {slow} and {fast.least:.3f} to {fast.most:.3f} s at speed {mover.speed}"
    )
    if other.most <= LONGER * fast.least or other.least > LONGER * fast.most:
        probe.expect(FASTER, other.least > LONGER * fast.most, reason)
    else:
        probe.not_timed(FASTER, f"The angles were read too seldom: {reason}.")


class _Seconds(NamedTuple):
    """A time that is known only between two readings."""

    least: float
    most: float


def _seconds(mover: Mover, start: Pose, target: Pose, speed: int) -> _Seconds:
    """Return the seconds that the joint with the largest angle to cover takes for half of it."""
    ways = [abs(b - a) for a, b in zip(start, target)]
    joint = ways.index(max(ways))
    device = mover.device
    began, least = device.connection.now, 0.0
    device.request(mover.to(target, speed))
    while least < LONGEST:
        sent_at = device.connection.now - began
        if abs(mover.angles()[joint] - start[joint]) >= WAY * ways[joint]:
            return _Seconds(least, device.connection.now - began)
        least = sent_at
        mover.rest(POLL)
    raise NotSupported(f"the arm did not move in {LONGEST:g} s")


SPEEDS = Group(
    "speeds",
    (FASTER,),
    _speeds,
    _has_speed,
    sends="The same motion at the speed limit, and at a tenth of it.",
    subject="the command that moves all joints, if it has a speed",
)
