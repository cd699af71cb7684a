"""The event at the end of a motion comes once, when the arm is at rest, with the right status."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import request_change
from cobotwire.conformance.device.groups.motion import UNDER_WAY, under_way
from cobotwire.conformance.device.mover import Mover, Pose, off_by
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import settings_of
from cobotwire.conformance.device.requests import request_of
from cobotwire.conformance.device.selection import stored
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Table
from cobotwire.session.events import EventReceived

ENDS = TestCase(
    "motion-ended",
    "The end of a motion is reported once, when the arm is at rest, with the right status.",
)

# In percent of the highest speed, so that the arm can be observed on its way.
SLOW = 20
# Seconds between two readings of the angles, and seconds without a change until the arm is at rest.
PERIOD, RESTS = 0.01, 0.7
# Names of the mode that interpolates motions. In other modes the ends of motions are not reported.
INTERPOLATED = ("INTERPOLATION", "QUEUE")
# The field of the query that reports whether the arm reports the ends of motions.
SWITCH = "motion_ends"


class _Reading(NamedTuple):
    """A pose that was read; ``sent_at`` is when its query was sent."""

    sent_at: float
    pose: Pose


def _is_reported(table: Table, command: Command) -> bool:
    moves = command is table.find_role("joint targets")
    return moves and table.find_role("motion ended") is not None


def _ends(probe: Probe) -> None:
    """Move there and back, and stop on the way there."""
    mover, stop = Mover(probe.device), probe.device.command("stop")
    _interpolate(probe)
    poses = mover.pose(0), mover.pose(1)
    mover.go(poses[0])
    _readings(mover)
    slow = min(SLOW, mover.speed)
    for target in reversed(poses):
        _expect_end(probe, mover, target, slow)
    if stop is not None:
        _expect_end(probe, mover, poses[1], 1, stop)


def _interpolate(probe: Probe) -> None:
    """Have the arm interpolate motions and report their ends, if a setting chooses that.

    Raises:
        NotSupported: it does not, and the run may not change it.
    """
    device = probe.device
    for command in device.table.commands:
        if "fresh_mode" not in stored(command):
            continue
        field = command.request[0].fields[0]
        [name] = [name for name in field.labels if name in INTERPOLATED]
        mode = request_of(command, field.choices[field.labels.index(name)])
        # Where no query reports the mode, the one that the edition names first is the default.
        old, needed = request_of(command, field.choices[0]), {"setting", "irreversible"}
        for setting in settings_of(device.table, command):
            old = setting.again(setting.queries[0], device.require(setting.queries[0]))
            needed = {"setting"} if old != mode else set()
        if missing := device.permissions.missing(frozenset(needed)):
            raise NotSupported(f"the mode may not be {name}; setting it needs {missing}")
        if needed:
            device.restore_after_body[command.name] = partial(device.request, old)
            device.request(mode)
    for query in device.table.commands:
        plain = query.safety == "query" and query.requires_reply and not query.request[0].fields
        if plain and SWITCH in [f.name for variant in query.reply for f in variant.fields]:
            reply = device.read(query.request_type())
            if reply is not None and not reply.fields[SWITCH]:
                raise NotSupported(
                    f"{query.name} reports that the ends of motions are not reported"
                )


def _expect_end(
    probe: Probe, mover: Mover, target: Pose, speed: int, stop: Command | None = None
) -> None:
    """Start a motion, perhaps stop it, and check the events until the arm has been at rest."""
    requester, event = probe.device.requester, probe.device.edition.in_role("motion ended")
    requester.events.clear()
    request_change(probe, request_of(probe.command, target, speed))
    if stop is not None:
        mover.rest(UNDER_WAY)
        if not under_way(probe, mover, target, ENDS):
            return
        probe.device.request(stop.request_type())
    readings, events = _readings(mover), list(requester.events)
    call = f"{stop.name if stop else probe.command.name}: expected one {event.name}"
    reported = ", ".join(f"{_status(each)} at {at:.3f} s" for at, each in events) or "none"
    probe.expect(ENDS, len(events) == 1, f"{call} at the end of the motion; received {reported}")
    for at, each in events[:1]:
        later = [reading for reading in readings if reading.sent_at > at]
        moved = off_by(later[0].pose, later[-1].pose, mover.tolerance, "ends at") if later else []
        reason = f"{call}, when the arm is at rest; at {at:.3f} s it was on its way"
        probe.expect(ENDS, not moved, f"{reason}: {'; '.join(moved)}")
        right = _is_right(probe, each, stopped=stop is not None)
        way = "for a motion that was stopped" if stop else "for a motion to its target"
        probe.expect(ENDS, right, f"{call} {way}; received {_status(each)}")


def _readings(mover: Mover) -> list[_Reading]:
    """Read the angles until they have not changed for some time."""
    connection = mover.device.connection
    readings = [_Reading(connection.now, mover.angles())]
    last, still_since = readings[0].pose, connection.now
    while readings[-1].sent_at - still_since < RESTS:
        mover.rest(PERIOD)
        readings.append(_Reading(connection.now, mover.angles()))
        if off_by(readings[-1].pose, last, mover.tolerance):
            last, still_since = readings[-1].pose, connection.now
    return readings


def _status(event: EventReceived) -> str:
    return ", ".join(f"{name} {value}" for name, value in event.message.fields.items())


def _is_right(probe: Probe, event: EventReceived, *, stopped: bool) -> bool:
    """Return whether the status reports success, or a stop if the motion was stopped.

    Any status is right for a stop if the edition states none.
    """
    codes, field = probe.device.edition.robot.error_codes, event.message.variant.fields[-1]
    if not stopped:
        return event.command.refusal(event.message.fields) is None
    if codes is None or not codes.stopped:
        return True
    # A motion may be stopped in several ways, each with a status; their meanings begin alike.
    value, meaning = event.message.fields[field.name], field.meaning(codes.stopped)
    alike = bool(meaning) and field.meaning(value).startswith(meaning)
    return value == codes.stopped or alike


MOTION_ENDS = Group(
    "ends of motions",
    (ENDS,),
    _ends,
    _is_reported,
    sends="Two motions to their targets, and one that is stopped; the angles are read throughout.",
    subject="the command that moves all joints, if an event reports the end of a motion",
)
