"""Motion inside the workspace: the arm arrives, reports it, stops, and stays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.mover import POLL, Mover, Pose, off_by
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, settings_of
from cobotwire.conformance.device.requests import flag_text, request_of
from cobotwire.conformance.suite import Group, Selects, TestCase
from cobotwire.protocol.messages import Reply, Request
from cobotwire.protocol.roles import ANGLES, reached_query
from cobotwire.protocol.table import Command, Role, Table

ARRIVES = TestCase("arrives", "The arm goes where it was sent, and its other joints stay.")
REACHED = TestCase("reached", "The arm reports that it is where it was sent, and nowhere else.")
MOVING = TestCase("moving", "The arm reports that it moves while it does, and not at rest.")
STOPS = TestCase("stops", "A stop ends the motion, and the arm stays at rest.")

# The tolerance between sent and read values, by unit: one tick, and the end's motion within it.
NEAR = {"millimetre": 1.5, "tick": 1.0, "percent": 1.0}
# After this time, in seconds, an arm on its way reports that it moves.
UNDER_WAY = 0.1
ARRIVED = "The arm had arrived before it could be observed on the way."
# How often, and for how long, it is observed whether the arm reports that it moves, in seconds.
LOOK, OBSERVED = 0.01, 2.0


def _has(role: Role) -> Selects:
    return lambda table, command: command.role == role


def _to_poses(probe: Probe) -> None:
    """Move all joints at once, from pose to pose."""
    mover, moving = Mover(probe), probe.device.command("moving")
    observed = []
    for which in (0, 1):
        pose, other = mover.pose(which), mover.pose(1 - which)
        mover.go(other)
        request_change(probe, request_of(probe.command, pose, mover.speed))
        motion = Motion(mover.angles, other, pose, mover.tolerance)
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
    mover = Mover(probe)
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
    """Send what was read at another pose: the arm returns there, and reads the same."""
    mover = Mover(probe)
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
            # Every variant shows in the first two; the first variant is sent with all of them.
            for target in targets if number == 0 else targets[:2]:
                _replay(probe, mover, motion, query, target)


def _targets(
    mover: Mover, motion: Setting, query: Request[Any], first: Reply[Any], second: Reply[Any]
) -> list[Request[Any]]:
    """Return the request for the first pose; or samples, if the second is read as the same."""
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


def _stops(probe: Probe) -> None:
    """Stop on the way: the arm is short of its target, and stays there."""
    mover, moving = Mover(probe), probe.device.command("moving")
    start, target = mover.pose(0), mover.pose(1)
    mover.go(start)
    probe.device.request(mover.to(target, 1))
    motion = Motion(mover.angles, start, target, mover.tolerance)
    observed = expect_on_the_way(probe, moving, motion)
    mover.rest(UNDER_WAY)
    if not under_way(probe, mover, target, STOPS):
        return
    request_change(probe, probe.command.request_type())
    # The arm slows down first.
    mover.rest(POLL)
    expect_rest(probe, moving)
    if not observed:
        probe.not_timed(MOVING, ARRIVED)
    stopped = mover.angles()
    mover.rest(4 * UNDER_WAY)
    wrong = off_by(mover.angles(), stopped, mover.tolerance, "was at")
    probe.expect(STOPS, not wrong, f"after {probe.command.name}: {'; '.join(wrong)}")
    short = bool(off_by(stopped, target, mover.tolerance))
    probe.expect(STOPS, short, f"{probe.command.name}: expected the arm to stop on its way")
    resume(probe)


def resume(probe: Probe) -> None:
    """Resume motion: after a stop, some firmware ignores motion requests until then."""
    for query in probe.device.table.commands:
        going = probe.device.setter(query, 0)
        if going is not None and going.safety == "motion" and query.safety == "query":
            probe.device.request(going.request_type())


class Motion(NamedTuple):
    """A motion that has just been requested: what reads its place, where from and where to.

    ``near`` is how far from a place its readings may be.
    """

    place: Callable[[], Pose]
    start: Pose
    target: Pose
    near: float


def expect_on_the_way(probe: Probe, query: Command | None, motion: Motion) -> bool:
    """Expect a query, if the edition has it, to report motion; return whether that was observed.

    A reply counts if the places that are read before and after it are neither the start nor the
    target. So the verdict does not depend on how late the host is, or how fast the arm.
    """
    device, missed, reported = probe.device, False, None
    left_at: float | None = None
    until = device.connection.now + OBSERVED
    while query is not None and device.connection.now < until:
        sent_at, reported = device.connection.now, device.is_set(query.request_type())
        place = motion.place()
        if not off_by(place, motion.target, motion.near):
            break
        if left_at is None:
            left_at = device.connection.now if off_by(place, motion.start, motion.near) else None
        elif reported:
            probe.expect(MOVING, True, "")
            return True
        else:
            missed = missed or sent_at - left_at >= UNDER_WAY
        device.connection.clock.sleep(LOOK)
    if missed and query is not None:
        expected = f"{query.name}: expected {flag_text(query, True)} on the way"
        probe.expect(MOVING, False, f"{expected}; came {flag_text(query, reported)}")
    return missed or query is None


def expect_rest(probe: Probe, query: Command | None) -> None:
    """Expect a query, if the edition has it, to report no motion."""
    if query is not None:
        reported = probe.device.is_set(query.request_type())
        expected = f"{query.name}: expected {flag_text(query, False)} at rest"
        probe.expect(MOVING, reported is False, f"{expected}; came {flag_text(query, reported)}")


def under_way(probe: Probe, mover: Mover, target: Pose, case: TestCase) -> bool:
    """Return whether the arm has not reached its target; give no verdict on a test case if so."""
    on_the_way = bool(off_by(mover.angles(), target, mover.tolerance))
    if not on_the_way:
        probe.not_timed(case, ARRIVED)
    return on_the_way


def _expect_reached(probe: Probe, pose: Pose, there: bool) -> None:
    query = reached_query(probe.device.table)
    if query is not None and ANGLES in query.kinds:
        reported = probe.device.is_set(query.request(pose, ANGLES))
        expected = f"{query.command.name}{pose}: expected {flag_text(query.command, there)}"
        reason = f"{expected}; came {flag_text(query.command, reported)}"
        probe.expect(REACHED, reported is there, reason)


POSES = Group(
    "poses",
    (ARRIVES, REACHED, MOVING, *AFTER_CHANGE),
    _to_poses,
    _has("joint targets"),
    sends=(
        "Two poses inside the workspace, in turns; the arm's state on the way and at the end "
        "is read."
    ),
    subject="the command that moves all joints",
)
JOINTS = Group(
    "single joints",
    (ARRIVES, *AFTER_CHANGE),
    _to_angles,
    _has("joint target"),
    sends="A target for one joint after the other.",
    subject="the command that moves one joint",
)
REPLAYS = Group(
    "replays",
    (ARRIVES, *AFTER_CHANGE),
    _replays,
    is_replayed,
    sends=(
        "What a query has reported at another pose; or samples, if it does not depend on the pose."
    ),
    subject="each motion with a target that a query reports",
)
STOPPING = Group(
    "stops",
    (STOPS, MOVING, *AFTER_CHANGE),
    _stops,
    _has("stop"),
    sends="A slow motion, and the stop on its way.",
    subject="the command that stops the arm",
)
