"""Motion of one joint or axis: by a step, to a coordinate, or until a stop; the others stay."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.motion import ARRIVES, STOPS, UNDER_WAY, resume
from cobotwire.conformance.device.mover import POLL, POSES, Mover
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.selection import does, first
from cobotwire.conformance.suite import Group
from cobotwire.protocol.effects import Does, Moves
from cobotwire.protocol.messages import Request

# The length of a step, by unit: far more than a tick, but still short.
DISTANCES = {"degree": 4.0, "millimetre": 8.0}
# How far other joints or axes may stray: joints rest on encoder ticks, which also moves the end.
STRAYS = {"degree": 0.6, "millimetre": 2.5}
# Slow enough to be stopped near the start, in percent of the highest speed.
SLOW = 20
# A jog is stopped when a joint or axis has moved by this multiple of its value in STRAYS.
SHOWS = 3.0

STEPPING, JOGGING = does(Moves, by=True), does(Moves, until="limit")
TO_COORDINATE = does(Moves, part="end", about=True, to=True)
HALTS = does(Does, what="halt", at=False)


class _Parts:
    """The joints or axes that a command moves one by one, and the query that reports them.

    ``places`` has, for each value of the argument that names a joint or axis, the index of its
    number in the query's reply. None: the end turns in place, which changes no single number.
    """

    def __init__(self, probe: Probe, motion: Moves) -> None:
        query = probe.device.command("coordinates" if motion.about else "joints")
        if query is None:
            raise NotSupported("no query reports where the arm is")
        self.probe, self.motion, self.mover = probe, motion, Mover(probe.device)
        self.query, self.numbers = query.request_type(), query.reply[0].fields[0].cases[0].numbers
        fields = {field.name: field for field in probe.command.request[0].fields}
        self.part, self.way = fields[motion.about or motion.at[0]], fields.get(motion.direction)
        if motion.about:
            names = [] if motion.keeps else [number.name for number in self.numbers]
            labels = [label.lower() for label in self.part.labels]
            found = [names.index(label) if label in names else None for label in labels]
            self.places = dict(zip(self.part.choices, found))
        else:
            # The argument may also name joints of a waist, which the query does not report.
            joint = self.part.cases[0].numbers[0]
            every = self.part.choices or range(joint.minimum, joint.maximum + 1)
            self.places = {at: at - 1 for at in every if at <= probe.device.table.joints}

    def where(self) -> Sequence[float]:
        """Return the position of the joints, or of the end."""
        return tuple(self.probe.device.require(self.query).result)

    def apart(self, one: Sequence[float], other: Sequence[float], often: float = 1.0) -> list[int]:
        """Return the indices at which two positions differ by more than ``often`` times STRAYS."""
        every = enumerate(zip(one, other, self.numbers))
        return [at for at, (a, b, n) in every if abs(a - b) > often * STRAYS[n.unit]]

    def request(self, part: int, speed: int, **others: float) -> Request[Any]:
        """Return the request that moves a joint or axis."""
        speeds = {self.motion.speed: speed} if self.motion.speed else {}
        fields = {self.part.name: part, **speeds, **others}
        return self.probe.command.request_type.from_fields(fields)

    def call(self, part: int) -> str:
        """Return the start of the call for a joint or axis, for messages that complete it."""
        return f"{self.probe.command.name}({self.part.name}={part}"

    def expect_motion(self, moved: bool, detail: str = "") -> None:
        """Expect that something has moved."""
        reason = f"{self.probe.command.name}: the arm did not move from any of {len(POSES)} poses"
        self.probe.expect(ARRIVES, moved, reason + detail)


def _nearby(probe: Probe, motion: Moves) -> None:
    """Move each joint or axis a short distance up and down.

    An arm may reject targets that it cannot reach. A direction in which it moves from no pose is
    taken as out of reach. An arm that moves in no direction fails.
    """
    parts = _Parts(probe, motion)
    stays = [
        _stays(parts, part, at, sign)
        for part, at in parts.places.items()
        if at is not None
        for sign in (1, -1)
    ]
    parts.expect_motion(None in stays, f"; {next(filter(None, stays), '')}")


def _stays(parts: _Parts, part: int, at: int, sign: int) -> str | None:
    """Try to move a joint or axis in one direction, from one pose after another, until it moves.

    Return what was sent and received if the arm never moves; None if it moves.
    """
    probe, motion, numbers, stayed = parts.probe, parts.motion, parts.numbers, ""
    distance = sign * DISTANCES[numbers[at].unit]
    call = f"{parts.call(part)}), {distance} {numbers[at].units} from there"
    for which in parts.mover.poses:
        parts.mover.go_near(which)
        before = parts.where()
        target = round(before[at] + distance, 2)
        way = {motion.by: distance} if motion.by else {str(motion.to): target}
        request = parts.request(part, parts.mover.speed, **way)
        if probe.device.cannot_send(request):
            # The edition does not allow the step from this pose; another pose is nearer to the
            # middle.
            continue
        request_change(probe, request)
        parts.mover.wait()
        after = parts.where()
        if parts.apart(before, after):
            probe.device.note_motion(which)
            right = [*before[:at], target, *before[at + 1 :]]
            wrong = "; ".join(
                f"{numbers[i].name}: expected {right[i]:.2f}, is {after[i]:.2f} {numbers[i].units}"
                for i in parts.apart(right, after)
            )
            probe.expect(ARRIVES, not wrong, f"{call}: {wrong}")
            return None
        stayed = stayed or f"{call}: it moved by {after[at] - before[at]:.2f}"
    return stayed


def _jogs(probe: Probe, motion: Moves) -> None:
    """Jog in both directions, and stop; as with steps, some directions may be out of reach."""
    parts, went = _Parts(probe, motion), False
    for part, at in parts.places.items():
        ways = parts.way.choices if parts.way else ()
        one, other = (_jog(parts, part, at, way) for way in ways)
        went = went or bool(one or other)
        if one and other and at is not None and not motion.about:
            # The edition does not state the direction of a joint.
            reason = (
                f"{parts.call(part)}): expected the directions {ways[0]} and {ways[1]} to be "
                f"opposite; it moved by {one[at]:.2f} and by {other[at]:.2f} degrees"
            )
            probe.expect(ARRIVES, one[at] * other[at] < 0, reason)
    parts.expect_motion(went)


def _jog(parts: _Parts, part: int, at: int | None, direction: int) -> list[float]:
    """Try to jog a joint or axis in a direction, from one pose after another, until it moves.

    Return by how much each joint or axis has moved; empty if nothing has.
    """
    probe, mover, device = parts.probe, parts.mover, parts.probe.device
    for which in mover.poses:
        mover.go_near(which)
        before, began = parts.where(), device.connection.now
        way = {parts.motion.direction: direction}
        request_change(probe, parts.request(part, min(SLOW, mover.speed), **way))
        # A distance that shows clearly, but is short, since the target may be out of reach.
        clear = partial(parts.apart, before, often=SHOWS)
        device.poll(parts.where, clear, 4 * UNDER_WAY, POLL)
        after = _stopped(parts, device.connection.now - began)
        if parts.apart(before, after):
            device.note_motion(which)
            moved = [now - then for now, then in zip(after, before)]
            wrong = _unmet(parts, at, direction, moved)
            reason = f"{parts.call(part)}, {direction}): expected {wrong}; it moved by "
            probe.expect(ARRIVES, not wrong, reason + ", ".join(f"{by:.2f}" for by in moved))
            return moved
    return []


def _stopped(parts: _Parts, seconds: float) -> Sequence[float]:
    """Stop, and return where the arm is then; expect that it stays there.

    Without the stop it would move by more than STRAYS allows within ``seconds``.
    """
    probe, mover = parts.probe, parts.mover
    ending, stop = first(probe.device.table, HALTS), probe.device.command("stop")
    stops = [each.request_type() for each in (ending or stop, stop) if each is not None]
    for each in stops[:1]:
        probe.device.request(each)
    mover.rest(2 * UNDER_WAY)
    stopped = parts.where()
    mover.rest(max(seconds, UNDER_WAY))
    later = parts.where()
    for each in stops[-1:]:
        probe.device.request(each)
    resume(probe)
    reason = f"after a stop: at {stopped}, then at {later}"
    probe.expect(STOPS, not parts.apart(stopped, later), reason)
    return stopped


def _unmet(parts: _Parts, at: int | None, direction: int, moved: Sequence[float]) -> str:
    """Describe the motion that was expected; empty if it happened."""
    far, numbers = parts.apart(moved, [0.0] * len(moved)), parts.numbers
    if at is None:
        turns = all(numbers[each].unit == "degree" for each in far)
        return "" if turns else "the end to turn in place"
    if far != [at]:
        return f"only {numbers[at].name} to move"
    # Jogging forward increases a coordinate; for a joint the edition defines only "clockwise".
    ways = dict(zip(parts.way.labels, parts.way.choices)) if parts.way else {}
    forward = ways.get("FORWARD") == direction
    if "FORWARD" in ways and (moved[at] > 0) is not forward:
        return f"{numbers[at].name} to {'increase' if forward else 'decrease'}"
    return ""


COORDINATES = Group(
    "single coordinates",
    (ARRIVES, *AFTER_CHANGE),
    *for_found(TO_COORDINATE, _nearby),
    sends="Targets a short distance above and below the present coordinate of each axis.",
    subject="the command that moves the end to one coordinate",
)
STEPS = Group(
    "steps",
    (ARRIVES, *AFTER_CHANGE),
    *for_found(STEPPING, _nearby),
    sends="A step up and down for each joint or axis.",
    subject="each motion by a distance",
)
JOGS = Group(
    "jogs",
    (ARRIVES, STOPS, *AFTER_CHANGE),
    *for_found(JOGGING, _jogs),
    sends="A short jog in both directions for each joint or axis, and a stop.",
    subject="each motion in a direction",
)
