"""What happens to a target if the next one comes while the arm is on its way."""

from __future__ import annotations

from functools import partial

from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.switching import EFFECT
from cobotwire.conformance.device.mover import Mover
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import request_of
from cobotwire.conformance.suite import Group
from cobotwire.protocol.table import Command, Table

# The names of the two modes.
QUEUED, NEWEST = "INTERPOLATION", "REFRESH"
# How far apart the targets are, how far the arm must go to show its direction, both in degrees,
# and how long that may take, in seconds.
WAY, SHOWN, LONGEST = 8.0, 1.0, 10.0
POLL = 0.02
# Slow enough to be seen on the way up, in percent of the fastest, and the longest time between two
# readings in which the arm cannot go up and down, in seconds.
SLOW, UNSEEN = 20, 0.1


def _chooses_mode(table: Table, command: Command) -> bool:
    """Return whether a setting chooses between the two modes."""
    fields = command.request[0].fields
    return command.safety == "setting" and len(fields) == 1 and fields[0].labels == (QUEUED, NEWEST)


def _next_target(probe: Probe) -> None:
    """Send joint 1 up and, in the same write, down: it goes up first if targets are queued."""
    mover, mode = Mover(probe), probe.command.request[0].fields[0]
    # The mode that the edition names first is its default.
    default = partial(probe.device.request, request_of(probe.command, mode.choices[0]))
    probe.device.restore_after_body[probe.command.name] = default
    pose = mover.pose(2)
    up, down = ((pose[0] + way, *pose[1:]) for way in (WAY, -WAY))
    for label in (NEWEST, QUEUED):
        choice = mode.choices[mode.labels.index(label)]
        request_change(probe, request_of(probe.command, choice))
        mover.go(pose)
        requester, speed = probe.device.requester, min(SLOW, mover.speed)
        first, then = (requester.prepare(mover.to(target, speed)) for target in (up, down))
        note = f"{requester.describe(first)}, {requester.describe(then)}"
        sent_at = requester.send_instead(first, first.frame + then.frame, note).sent_at
        way = _first_motion(mover, pose[0], sent_at)
        mover.wait()
        reason = f"{label}: expected joint 1 to go {'up' if label == QUEUED else 'down'} first"
        if way is None:
            probe.not_timed(EFFECT, f"The angles were read too seldom. {reason}.")
        else:
            probe.expect(EFFECT, (way > 0) is (label == QUEUED), reason)


def _first_motion(mover: Mover, start: float, before: float) -> float | None:
    """Return how far joint 1 is from its start, in degrees, as soon as it has left it.

    ``before`` is when it was at its start, in seconds of the run. None: it was not read in time.
    """
    until = mover.device.connection.now + LONGEST
    while mover.device.connection.now < until:
        sent_at, way = mover.device.connection.now, mover.angles()[0] - start
        if abs(way) > SHOWN:
            return way if mover.device.connection.now - before <= UNSEEN else None
        before = sent_at
        mover.rest(POLL)
    return 0.0


NEXT_TARGET = Group(
    "next target",
    (EFFECT, *AFTER_CHANGE),
    _next_target,
    _chooses_mode,
    frozenset({"motion", "irreversible"}),
    sends="In each mode: joint 1 up, and at once down.",
    subject="the setting that chooses what happens to a target when the next one comes",
)
