"""Motion inside the workspace: the arm arrives, reports it, stops, and stays."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.mover import Mover, Pose, off_by
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.read_back import (
    SavedValue,
    Setting,
    restorable_value,
    settings_of,
)
from cobotwire.conformance.device.requests import flag_text, request_of
from cobotwire.conformance.device.selection import does, first, has_role, stored
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.effects import Does
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.roles import ANGLES, reached_query
from cobotwire.protocol.table import Command, Table

ARRIVES = TestCase("arrives", "The arm goes where it was sent, and its other joints stay.")
REACHED = TestCase("reached", "The arm reports that it is where it was sent, and nowhere else.")
MOVING = TestCase(
    "moving", "The arm reports that it moves while it does, and not at rest.", timed=True
)
KEEPS = TestCase("limits-kept", "No joint moves beyond the limit that is set for it.")
STOPS = TestCase("stops", "A stop ends the motion, and the arm stays at rest.", timed=True)

# The tolerance between sent and read values, by unit: one tick, and how far a tick moves the arm.
NEAR = {"millimetre": 1.5, "tick": 1.0, "percent": 1.0}
# An arm must report that it moves once it has been on its way for this long, in seconds.
UNDER_WAY = 0.1
ARRIVED = "The arm had arrived before it could be observed on the way."
# The period and the duration of the queries whether the arm moves, in seconds.
PERIOD, OBSERVED = 0.01, 2.0
# The distances of the limit and of the target from the present angle, as shares of the joint's
# range in the workspace; and how far beyond the limit a joint may come to rest, in degrees.
LIMIT, TARGET, BEYOND = 0.04, 0.10, 1.0
# The pose from which the joints move.
POSE = 2


def _to_poses(probe: Probe) -> None:
    """Move all joints at once, from pose to pose."""
    mover, moving = Mover(probe.device), probe.device.command("moving")
    observed = []
    for which in (0, 1):
        pose, other = mover.pose(which), mover.pose(1 - which)
        mover.go(other)
        request_change(probe, request_of(probe.command, pose, mover.speed))
        motion = Motion(mover.place, other, pose, mover.tolerance)
        observed.append(expect_on_the_way(probe, moving, motion))
        mover.wait()
        wrong = mover.differences(pose)
        probe.expect(ARRIVES, not wrong, f"{probe.command.name}: {'; '.join(wrong)}")
        expect_rest(probe, moving)
        _expect_reached(probe, pose, True)
        _expect_reached(probe, other, False)
    if not any(observed):
        probe.not_timed(MOVING, ARRIVED)


def _to_angles(probe: Probe) -> None:
    """Move one joint after the other; the rest stay."""
    mover = Mover(probe.device)
    expected, target = mover.pose(0), mover.pose(1)
    mover.go(expected)
    for at, angle in enumerate(target):
        request_change(probe, request_of(probe.command, at + 1, angle, mover.speed))
        mover.wait()
        expected = (*expected[:at], angle, *expected[at + 1 :])
        wrong = mover.differences(expected)
        call = f"{probe.command.name}(joint {at + 1}, {angle} degree)"
        probe.expect(ARRIVES, not wrong, f"{call}: {'; '.join(wrong)}")


def is_replayed(table: Table, command: Command) -> bool:
    """Return whether a query reports the target of a motion."""
    sent = command.role in ("", "coordinate targets")
    return command.safety == "motion" and sent and bool(settings_of(table, command))


def _replays(probe: Probe) -> None:
    """Send values that were read at another pose: the arm returns there, and reports them again."""
    mover = Mover(probe.device)
    motions = settings_of(probe.device.table, probe.command)
    # Everything is read at each pose once: going there takes the most time.
    queries = dict.fromkeys(query for motion in motions for query in motion.queries)
    mover.go(mover.pose(0))
    first = {query: probe.device.require(query) for query in queries}
    mover.go(mover.pose(1))
    second = {query: probe.device.require(query) for query in queries}
    for number, motion in enumerate(motions):
        for query in motion.queries:
            targets = _targets(mover, motion, query, first[query], second[query])
            # The first variant is sent with all targets; two suffice for each other variant.
            for target in targets if number == 0 else targets[:2]:
                _replay(probe, mover, motion, query, target)


def _targets(
    mover: Mover, motion: Setting, query: Request[Any], first: Reply[Any], second: Reply[Any]
) -> list[Request[Any]]:
    """Return the request that sets the first reading; samples if both readings are the same."""
    target = motion.again(query, first, mover.speed)
    if target != motion.again(query, second, mover.speed):
        return [target]
    return motion.samples(query, first, mover.speed)


def _replay(
    probe: Probe, mover: Mover, motion: Setting, query: Request[Any], target: Request[Any]
) -> None:
    request_change(probe, target)
    mover.settle(lambda: probe.device.read(query))
    near = {**NEAR, "degree": mover.tolerance}
    wrong = motion.differences(target, probe.device.read(query), near)
    probe.expect(ARRIVES, not wrong, f"{probe.command.name}: {'; '.join(wrong)}")


def resume(probe: Probe) -> None:
    """Resume motion: after a stop, some firmware ignores motion requests until it is resumed."""
    going_on = first(probe.device.table, does(Does, what="resume"))
    if going_on is not None:
        probe.device.request(going_on.request_type())


class Motion(NamedTuple):
    """A motion that has just been requested: the query of the position, the start and the target.

    ``place`` returns None if the reply is not legal; ``near`` is the tolerance of its readings.
    """

    place: Callable[[], Pose | None]
    start: Pose
    target: Pose
    near: float


def expect_on_the_way(probe: Probe, query: Command | None, motion: Motion) -> bool:
    """Expect a query, if the edition has it, to report motion; return whether that was observed.

    A reply counts if the positions that are read before and after it are neither the start nor the
    target. So the verdict depends neither on the speed of the arm nor on delays of the host.
    """
    device, missed, reported = probe.device, False, None
    left_at: float | None = None
    until = device.connection.now + OBSERVED
    while query is not None and device.connection.now < until:
        sent_at, reported = device.connection.now, device.is_set(query.request_type())
        place = motion.place()
        if place is None or not off_by(place, motion.target, motion.near):
            break
        if left_at is None:
            left_at = device.connection.now if off_by(place, motion.start, motion.near) else None
        elif reported:
            probe.expect(MOVING, True, "")
            return True
        else:
            missed = missed or sent_at - left_at >= UNDER_WAY
        device.connection.clock.sleep(PERIOD)
    if missed and query is not None:
        expected = f"{query.name}: expected {flag_text(query, True)} on the way"
        probe.expect(MOVING, False, f"{expected}; received {flag_text(query, reported)}")
    return missed or query is None


def expect_rest(probe: Probe, query: Command | None) -> None:
    """Expect a query, if the edition has it, to report no motion."""
    if query is not None:
        probe.expect_flag(MOVING, query.request_type(), False, when=" at rest")


def under_way(probe: Probe, mover: Mover, target: Pose, case: TestCase) -> bool:
    """Return whether the arm is still on its way; if not, the test case has no verdict."""
    on_the_way = bool(off_by(mover.angles(), target, mover.tolerance))
    if not on_the_way:
        probe.not_timed(case, ARRIVED)
    return on_the_way


def _expect_reached(probe: Probe, pose: Pose, there: bool) -> None:
    query = reached_query(probe.device.table)
    if query is not None and ANGLES in query.kinds:
        call = f"{query.command.name}{pose}"
        probe.expect_flag(REACHED, query.request(pose, ANGLES), there, call)


def _limit(table: Table, command: Command) -> Setting | None:
    """Return the setting of a limit of one joint, in degrees, that a query reads."""
    limits, single = {"lowest", "highest"} & set(stored(command)), command.request[0].fields[1:]
    return next(iter(settings_of(table, command)), None) if limits and single else None


def _keeps(probe: Probe, setting: Setting) -> None:
    """Set a limit near the joint, and send the joint beyond it."""
    # The first and the last joint; a firmware that keeps these limits keeps the others.
    for query in (setting.queries[0], setting.queries[-1]):
        at = int(query.values[0]) - 1
        if at < len(probe.device.permissions.workspace):
            _beyond(probe, restorable_value(probe.device, setting, query), at)


def _beyond(probe: Probe, saved: SavedValue, at: int) -> None:
    mover, device = Mover(probe.device), probe.device
    mover.go(mover.pose(POSE))
    here, (low, high) = mover.angles(), device.permissions.workspace[at]
    way = (high - low) * (-1 if "lowest" in stored(probe.command) else 1)
    limit, target = round(here[at] + LIMIT * way), here[at] + TARGET * way
    [(_, argument)] = saved.setting.pairs
    device.restore_after_body[probe.command.name] = partial(device.request, saved.old)
    fields = {**saved.old.fields, argument: limit}
    request_change(probe, probe.command.request_type.from_fields(fields))
    device.request(mover.to((*here[:at], round(target, 2), *here[at + 1 :])))
    mover.wait()
    beyond = (mover.angles()[at] - limit) * (1 if way > 0 else -1)
    reason = (
        f"{probe.command.name}(joint {at + 1}) set the limit to {limit} degrees; sent to "
        f"{target:.1f}, the joint went {beyond:.1f} degrees beyond the limit"
    )
    probe.expect(KEEPS, beyond <= BEYOND, reason)
    device.request(saved.old)


POSES = Group(
    "poses",
    (ARRIVES, REACHED, MOVING, *AFTER_CHANGE),
    _to_poses,
    has_role("joint targets"),
    sends=(
        "Two poses inside the workspace, alternately; the arm's state on the way and at the end "
        "is read."
    ),
    subject="the command that moves all joints",
)
JOINTS = Group(
    "single joints",
    (ARRIVES, *AFTER_CHANGE),
    _to_angles,
    has_role("joint target"),
    sends="A target for one joint after the other.",
    subject="the command that moves one joint",
)
REPLAYS = Group(
    "replays",
    (ARRIVES, *AFTER_CHANGE),
    _replays,
    is_replayed,
    sends=(
        "The values that a query reported at another pose; or samples, if its reply does not "
        "depend on the pose."
    ),
    subject="each motion with a target that a query reports",
)
LIMITS_KEPT = Group(
    "limits kept",
    (KEEPS,),
    *for_found(_limit, _keeps),
    frozenset({"motion"}),
    sends="A limit near the first and the last joint, and a motion beyond it; then the old limit.",
    subject="each command that sets a limit of the joints which a query reads",
)
