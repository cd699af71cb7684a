"""A higher speed moves the arm faster."""

from __future__ import annotations

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
    reason = (
        f"{probe.command.name}: half of the way took {took[slow]:.3f} s at speed {slow} and "
        f"{took[mover.speed]:.3f} s at speed {mover.speed}"
    )
    probe.expect(FASTER, took[slow] > LONGER * took[mover.speed], reason)


def _seconds(mover: Mover, start: Pose, target: Pose, speed: int) -> float:
    """Return the seconds that the joint with the largest angle to cover takes for half of it."""
    ways = [abs(b - a) for a, b in zip(start, target)]
    joint = ways.index(max(ways))
    device = mover.device
    began = device.connection.now
    device.request(mover.to(target, speed))
    while device.connection.now - began < LONGEST:
        if abs(mover.angles()[joint] - start[joint]) >= WAY * ways[joint]:
            return device.connection.now - began
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
