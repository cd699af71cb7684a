"""Test cases while the arm is on its way: stops and pauses, speeds, and the next target."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.motion import (
    ARRIVED,
    ARRIVES,
    MOVING,
    STOPS,
    UNDER_WAY,
    Motion,
    expect_on_the_way,
    expect_rest,
    resume,
    under_way,
)
from cobotwire.conformance.device.groups.switching import EFFECT
from cobotwire.conformance.device.mover import POLL, Mover, Pose, off_by
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.requests import request_of
from cobotwire.conformance.device.selection import does, first, has_role, stored
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.effects import Does, Reports
from cobotwire.protocol.table import Command, Table

PAUSES = TestCase(
    "pauses", "A pause holds the arm where it is, short of its target, and is reported.", timed=True
)
FASTER = TestCase("faster", "A higher speed moves the arm faster.", timed=True)
REPORTED = TestCase(
    "speeds-reported",
    "The speeds that a query reports are near zero at rest; on the way they fit the angles.",
    timed=True,
)

# The fast speed is SHARE times the slow one. The slow motion must take at least LONGER times as
# long. LONGER is less than SHARE, because on a short distance an arm does not reach its full speed.
SHARE, LONGER = 10, 1.25
# The motion is timed over this share of the distance between two poses.
TIMED = 0.5
# The longest time for that motion, and the pause between two readings of the position, in seconds.
LONGEST, SOON = 20.0, 0.005
# The names of the two modes.
QUEUED, NEWEST = "INTERPOLATION", "REFRESH"
# The distance of both targets from the start, and how far the arm must go to show its direction,
# in degrees.
WAY, SHOWN = 8.0, 1.0
# The speed of the motion upwards, in percent of the highest: slow enough for readings on the way.
UPWARDS = 20
# The longest time between two readings, in seconds: too short for the arm to go up and down again.
UNSEEN = 0.1
STEPS, TURNS = "step_per_second", "revolution_per_minute"
# One revolution per minute, in degrees per second.
TURN = 6.0
# The angles are read this long before and after the speeds, in seconds.
BESIDE = 0.1
# A joint is checked if it turns at least this far between the readings of its angle, in degrees.
LEAST = 0.4
# The factor by which a speed may be too large or too small: an arm speeds up and slows down.
APART = 3.0
# The speed of a joint at rest may be this share of the fastest one on the way: sensors have noise.
AT_REST = 0.1
# The motion is slow, so that it lasts longer than the readings; in percent of the highest.
SLOW = 5


def _stops(probe: Probe) -> None:
    """Stop on the way: the arm is short of its target, and stays there."""
    mover, moving = Mover(probe.device), probe.device.command("moving")
    observed = expect_on_the_way(probe, moving, _set_off(mover))
    if _stays_on_the_way(probe, mover, STOPS):
        expect_rest(probe, moving)
        if not observed:
            probe.not_timed(MOVING, ARRIVED)
        resume(probe)


def _set_off(mover: Mover) -> Motion:
    """Send the arm slowly from one pose to another."""
    start, target = mover.pose(0), mover.pose(1)
    mover.go(start)
    mover.device.request(mover.to(target, 1))
    return Motion(mover.place, start, target, mover.tolerance)


def _stays_on_the_way(probe: Probe, mover: Mover, case: TestCase) -> bool:
    """Send the command during a motion: the arm stops and stays.

    Return whether that was observed.
    """
    mover.rest(UNDER_WAY)
    if not under_way(probe, mover, mover.pose(1), case):
        return False
    request_change(probe, probe.command.request_type())
    # The arm slows down first.
    mover.rest(2 * POLL)
    here = mover.angles()
    mover.rest(4 * UNDER_WAY)
    moved = off_by(mover.angles(), here, mover.tolerance, "was at")
    reason = f"after {probe.command.name}, expected the arm to stay"
    probe.expect(case, not moved, f"{reason}; {'; '.join(moved)}")
    short = bool(off_by(here, mover.pose(1), mover.tolerance))
    probe.expect(case, short, f"{reason} on its way, but it is at its target")
    return True


def _resuming(table: Table, command: Command) -> Command | None:
    """Return the command that resumes, if a command pauses and a query reports the pause."""
    pauses = does(Does, what="pause")(table, command)
    known = table.find_role("paused") is not None
    return first(table, does(Does, what="resume")) if pauses and known else None


def _pause(probe: Probe, going_on: Command) -> None:
    """Pause on the way, and resume."""
    mover, paused = Mover(probe.device), probe.device.table.in_role("paused").request_type()
    _set_off(mover)
    if not _stays_on_the_way(probe, mover, PAUSES):
        return
    call = f"after {probe.command.name}, {paused.command}"
    probe.expect_flag(PAUSES, paused, True, call)
    request_change(probe, going_on.request_type())
    mover.wait()
    wrong = mover.differences(mover.pose(1))
    reason = f"{going_on.name} after {probe.command.name}, expected the arm to go on to its target"
    probe.expect(ARRIVES, not wrong, f"{reason}; {'; '.join(wrong)}")
    probe.expect_flag(PAUSES, paused, False, call)


def _has_speed(table: Table, command: Command) -> bool:
    """Return whether a command moves all joints at a speed."""
    fields = command.request[0].fields if command.role == "joint targets" else ()
    return any(field.cases[0].numbers[0].unit == "percent" for field in fields)


def _faster(probe: Probe) -> None:
    """Time the first half of the same motion at two speeds."""
    mover = Mover(probe.device)
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


class _Departure(NamedTuple):
    """How far a joint has moved, in degrees, and bounds of the seconds since the request."""

    way: float
    least: float
    most: float


def _departure(
    mover: Mover, joint: int, start: float, far: float, began: float, every: float
) -> _Departure | None:
    """Read the angle of a joint until it is ``far`` from its start; None: it does not move."""
    clock, least = mover.device.connection, 0.0
    while least < LONGEST:
        sent_at, way = clock.now - began, mover.angles()[joint] - start
        if abs(way) >= far:
            return _Departure(way, least, clock.now - began)
        least = sent_at
        mover.rest(every)
    return None


def _seconds(mover: Mover, start: Pose, target: Pose, speed: int) -> _Departure:
    """Return when the joint with the largest angle to cover has covered half of it."""
    ways = [abs(b - a) for a, b in zip(start, target)]
    joint, began = ways.index(max(ways)), mover.device.connection.now
    mover.device.request(mover.to(target, speed))
    departure = _departure(mover, joint, start[joint], TIMED * ways[joint], began, SOON)
    if departure is None:
        raise NotSupported(f"the arm did not move in {LONGEST:g} s")
    return departure


class _Speeds(NamedTuple):
    """The field of a reply with the speed of each joint, and its unit in degrees per second."""

    name: str
    unit: float

    def read(self, probe: Probe) -> Pose:
        """Return the speed of each joint, in degrees per second.

        Raises:
            NotSupported: no valid reply came.
        """
        row = probe.device.require(probe.command.request_type()).fields[self.name]
        return tuple(self.unit * value for value in row[: probe.device.joints])


def _speeds(table: Table, command: Command) -> _Speeds | None:
    """Return the first field of a query that has speeds in a unit of known size.

    Return None if there is no such field, or if the edition lacks a command that moves the joints
    or a query of their angles.
    """
    effect, encoders = does(Reports)(table, command), table.robot.encoders
    moves = table.find_role("joint targets") is not None and table.find_role("joints") is not None
    if effect is None or not command.reply or not moves:
        return None
    sizes = {TURNS: TURN} | ({STEPS: encoders.degrees} if encoders else {})
    for field in command.reply[0].fields:
        unit = sizes.get(field.cases[0].numbers[0].unit)
        if field.many and unit and effect.values.get(field.name) == "speeds":
            return _Speeds(field.name, unit)
    return None


def _reported(probe: Probe, speeds: _Speeds) -> None:
    """Move several sets of joints in turn.

    Each joint is in a different combination of sets, so that a wrong joint shows.
    """
    mover = Mover(probe.device)
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
        fastest = _expect_on_the_way(probe, mover, speeds, target, moved)
        mover.wait()
        _expect_rest(probe, speeds.read(probe), max(speeds.unit, AT_REST * fastest), "at rest")
        here = target


def _expect_on_the_way(
    probe: Probe, mover: Mover, speeds: _Speeds, target: Pose, moved: list[int]
) -> float:
    """Compare the speeds with the angles before and after; return how fast the fastest turned."""
    began, before = probe.device.connection.now, mover.angles()
    mover.rest(BESIDE)
    found = speeds.read(probe)
    mover.rest(BESIDE)
    after = mover.angles()
    took = probe.device.connection.now - began
    turned = [abs(b - a) / took for a, b in zip(before, after)]
    wrong = [
        f"joint {at + 1}: {abs(found[at]):.3g}, but it turned {turned[at]:.3g} degrees in a second"
        for at in moved
        # Joints that have nearly arrived are left out.
        if turned[at] * took >= LEAST and abs(after[at] - target[at]) > mover.tolerance
        if not turned[at] / APART <= abs(found[at]) <= APART * turned[at]
    ]
    reason = f"{probe.command.name}, in degrees per second on the way: {'; '.join(wrong)}"
    probe.expect(REPORTED, not wrong, reason)
    held = tuple(0.0 if at in moved else speed for at, speed in enumerate(found))
    near = max(speeds.unit, AT_REST * max(turned))
    _expect_rest(probe, held, near, "of joints that were held")
    return max(turned)


def _expect_rest(probe: Probe, speeds: Pose, near: float, when: str) -> None:
    """Expect that the speeds are near zero."""
    wrong = [
        f"joint {joint}: {speed:.3g}" for joint, speed in enumerate(speeds, 1) if abs(speed) > near
    ]
    reason = f"{probe.command.name}, in degrees per second {when}: {'; '.join(wrong)}"
    probe.expect(REPORTED, not wrong, reason)


def _chooses_mode(table: Table, command: Command) -> bool:
    """Return whether a setting chooses between the two modes."""
    fields = command.request[0].fields
    return "fresh_mode" in stored(command) and fields[0].labels == (QUEUED, NEWEST)


def _next_target(probe: Probe) -> None:
    """Send joint 1 up and, in the same write, down: it goes up first if targets are queued."""
    mover, mode = Mover(probe.device), probe.command.request[0].fields[0]
    # The mode that the edition names first is its default.
    default = partial(probe.device.request, request_of(probe.command, mode.choices[0]))
    probe.device.restore_after_body[probe.command.name] = default
    pose, requester, speed = mover.pose(2), probe.device.requester, min(UPWARDS, mover.speed)
    up, down = ((pose[0] + by, *pose[1:]) for by in (WAY, -WAY))
    for label in (NEWEST, QUEUED):
        choice = mode.choices[mode.labels.index(label)]
        request_change(probe, request_of(probe.command, choice))
        mover.go(pose)
        first, then = (requester.prepare(mover.to(target, speed)) for target in (up, down))
        note = f"{requester.describe(first)}, {requester.describe(then)}"
        sent_at = requester.send_instead(first, first.frame + then.frame, note).sent_at
        departure = _departure(mover, 0, pose[0], SHOWN, sent_at, POLL)
        mover.wait()
        reason = f"{label}: expected joint 1 to go {'up' if label == QUEUED else 'down'} first"
        if departure is not None and departure.most - departure.least > UNSEEN:
            probe.not_timed(EFFECT, f"The angles were read too seldom. {reason}.")
        else:
            went_up = departure is not None and departure.way > 0
            probe.expect(EFFECT, went_up is (label == QUEUED), reason)


STOPPING = Group(
    "stops",
    (STOPS, MOVING, *AFTER_CHANGE),
    _stops,
    has_role("stop"),
    sends="A slow motion, and the stop on its way.",
    subject="the command that stops the arm",
)
PAUSING = Group(
    "pauses",
    (PAUSES, ARRIVES, *AFTER_CHANGE),
    *for_found(_resuming, _pause),
    sends="A slow motion, the pause on its way, and the command that resumes.",
    subject="the command that pauses, if another one resumes",
)
SPEEDS = Group(
    "speeds",
    (FASTER,),
    _faster,
    _has_speed,
    sends="The same motion at the speed limit, and at a tenth of it.",
    subject="the command that moves all joints, if it has a speed",
)
REPORTED_SPEEDS = Group(
    "reported speeds",
    (REPORTED,),
    *for_found(_speeds, _reported),
    frozenset({"motion"}),
    sends="The query during three slow motions of some of the joints, and at rest.",
    subject="each query of the joints' speeds, if the edition says how large their unit is",
)
NEXT_TARGET = Group(
    "next target",
    (EFFECT, *AFTER_CHANGE),
    _next_target,
    _chooses_mode,
    frozenset({"motion", "irreversible"}),
    sends="In each mode, two targets in one write: joint 1 up, and joint 1 down.",
    subject="the setting that chooses what happens to a target when the next one comes",
)
