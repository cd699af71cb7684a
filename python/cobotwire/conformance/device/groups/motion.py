"""Motion inside the workspace: the arm arrives, reports it, stops, and stays."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.mover import POLL, Mover, Pose, off_by
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, settings_of
from cobotwire.conformance.device.requests import request_of
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
# After this time, in seconds, the arm reports that it moves and has not arrived yet.
UNDER_WAY = 0.1


def _has(role: Role) -> Selects:
    return lambda table, command: command.role == role


def _to_poses(probe: Probe) -> None:
    """Move all joints at once, from pose to pose."""
    mover, moving = Mover(probe), probe.device.command("moving")
    for which in (0, 1):
        pose, other = mover.pose(which), mover.pose(1 - which)
        mover.go(other)
        request_change(probe, request_of(probe.command, pose, mover.speed))
        expect_moving(probe, mover, moving, True)
        mover.wait()
        wrong = mover.differences(pose)
        probe.expect(ARRIVES, not wrong, f"{probe.command.name}: {'; '.join(wrong)}")
        expect_moving(probe, mover, moving, False)
        _expect_reached(probe, pose, True)
        _expect_reached(probe, other, False)


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
    mover.go(mover.pose(0))
    probe.device.request(mover.to(mover.pose(1), 1))
    mover.rest(UNDER_WAY)
    request_change(probe, probe.command.request_type())
    # The arm slows down first.
    mover.rest(POLL)
    expect_moving(probe, mover, moving, False)
    stopped = mover.angles()
    mover.rest(4 * UNDER_WAY)
    wrong = off_by(mover.angles(), stopped, mover.tolerance, "was at")
    probe.expect(STOPS, not wrong, f"after {probe.command.name}: {'; '.join(wrong)}")
    short = bool(off_by(stopped, mover.pose(1), mover.tolerance))
    probe.expect(STOPS, short, f"{probe.command.name}: expected the arm to stop on its way")
    resume(probe)


def resume(probe: Probe) -> None:
    """Resume motion: after a stop, some firmware ignores motion requests until then."""
    for query in probe.device.table.commands:
        going = probe.device.setter(query, 0)
        if going is not None and going.safety == "motion" and query.safety == "query":
            probe.device.request(going.request_type())


def expect_moving(probe: Probe, mover: Mover, query: Command | None, moves: bool) -> None:
    """Expect a query, if the edition has it, to report whether something moves."""
    if query is not None:
        if moves:
            mover.rest(UNDER_WAY)
        reported = probe.device.is_set(query.request_type())
        reason = f"{query.name}: expected {moves}; came {_came(reported)}"
        probe.expect(MOVING, reported is moves, reason)


def _expect_reached(probe: Probe, pose: Pose, there: bool) -> None:
    query = reached_query(probe.device.table)
    if query is not None and ANGLES in query.kinds:
        reported = probe.device.is_set(query.request(pose, ANGLES))
        reason = f"{query.command.name}{pose}: expected {there}; came {_came(reported)}"
        probe.expect(REACHED, reported is there, reason)


def _came(reported: bool | None) -> str:
    return "no valid reply" if reported is None else str(reported)


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
