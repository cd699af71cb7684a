"""Motion of one joint or axis: by a step, to a coordinate, or until a stop; the others stay."""

from __future__ import annotations

from collections.abc import Sequence

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.motion import ARRIVES, STOPS, UNDER_WAY, resume
from cobotwire.conformance.device.mover import POLL, POSES, Mover
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import request_of
from cobotwire.conformance.suite import Group
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.table import Command, Field, Number, Table

# A step by unit: far more than a tick, but still near.
DISTANCES = {"degree": 4.0, "millimetre": 8.0}
# How far the other joints or axes may stray. The end follows joints that rest on ticks.
STRAYS = {"degree": 0.6, "millimetre": 2.5}
# Slow enough to be stopped near the start, in percent of the fastest.
SLOW = 20
# A jog is stopped when it has moved something by this multiple of its value in STRAYS.
SHOWS = 3.0


def _shape(command: Command) -> tuple[Field, Field] | None:
    """Return the fields of a motion for its part and its distance or direction; else None."""
    if command.safety != "motion" or command.role or command.read_by or command.requires_reply:
        return None
    fields = command.request[0].fields
    if len(fields) != 3 or any(field.many for field in fields):
        return None
    part, travel, speed = fields
    if part.cases[0].numbers[0].real:
        return None
    return (part, travel) if speed.cases[0].numbers[0].unit == "percent" else None


def _is_step(table: Table, command: Command) -> bool:
    """Return whether a command moves one part by a distance."""
    shape = _shape(command)
    return shape is not None and shape[1].cases[0].numbers[0].real


def _is_jog(table: Table, command: Command) -> bool:
    """Return whether a command moves one part in one of two directions."""
    shape = _shape(command)
    return shape is not None and len(shape[1].choices) == 2


def _moves_one_axis(table: Table, command: Command) -> bool:
    """Return whether a command moves the arm's end to a coordinate of one axis."""
    return command.role == "coordinate target"


def _to_coordinates(probe: Probe) -> None:
    """Move the end a short distance along or about each axis; the other coordinates stay."""
    _nearby(probe, probe.command.request[0].fields[0], absolute=True)


def _step(probe: Probe) -> None:
    """Move each part by a step, up and down."""
    _nearby(probe, _parts(probe)[0], absolute=False)


def _nearby(probe: Probe, part: Field, *, absolute: bool) -> None:
    """Move each part a short distance up and down.

    An arm may reject what it cannot reach: a direction in which it moves from none of the poses
    counts as out of reach. An arm that moves in no direction fails.
    """
    mover = Mover(probe)
    stays = [
        _stays(probe, mover, part, chosen, sign, absolute=absolute)
        for chosen in _choices(probe, part)
        for sign in (1, -1)
    ]
    reason = f"{probe.command.name}: the arm moved from none of {len(POSES)} poses"
    reason += f"; {next(filter(None, stays), '')}"
    probe.expect(ARRIVES, None in stays, reason)


def _stays(
    probe: Probe, mover: Mover, part: Field, chosen: int, sign: int, *, absolute: bool
) -> str | None:
    """Move a part one way, from pose to pose, until it moves.

    Return what was sent and what came of it if it never moves; None: it moves.
    """
    stayed = ""
    for which in mover.poses:
        mover.go_near(which)
        before, numbers = _where(probe, part)
        at = _place(part, chosen, numbers)
        distance = sign * DISTANCES[numbers[at].unit]
        target = round(before[at] + distance, 2)
        try:
            way = target if absolute else distance
            request_change(probe, request_of(probe.command, chosen, way, mover.speed))
        except UsageError:
            # The edition does not allow it there; another pose is nearer to the middle.
            continue
        mover.wait()
        after, _ = _where(probe, part)
        call = f"{probe.command.name}({part.name}={chosen}), {distance} {numbers[at].units}"
        stayed = stayed or f"{call} from there: it moved by {after[at] - before[at]:.2f}"
        if _off(numbers, before, after):
            mover.prefer(which)
            wrong = _off(numbers, [*before[:at], target, *before[at + 1 :]], after)
            probe.expect(ARRIVES, not wrong, f"{call} from there: {'; '.join(wrong)}")
            return None
    return stayed


def _jogs(probe: Probe) -> None:
    """Jog each part both ways and stop; as with steps, some may be out of reach."""
    mover, (part, way) = Mover(probe), _parts(probe)
    went = False
    for chosen in _choices(probe, part):
        moved = [_jog(probe, mover, part, chosen, direction) for direction in way.choices]
        went = went or any(moved)
        if all(moved) and not part.labels:
            # Of a joint, the edition does not state the direction.
            one, other = (by[chosen - 1] for by in moved if by is not None)
            reason = (
                f"{probe.command.name}({part.name}={chosen}): expected the directions "
                f"{way.choices[0]} and {way.choices[1]} to be opposite; it moved by {one:.2f} and "
                f"by {other:.2f} degrees"
            )
            probe.expect(ARRIVES, one * other < 0, reason)
    reason = f"{probe.command.name}: the arm moved from none of {len(POSES)} poses"
    probe.expect(ARRIVES, went, reason)


def _jog(
    probe: Probe, mover: Mover, part: Field, chosen: int, direction: int
) -> list[float] | None:
    """Jog a part in a direction, from pose to pose, until it moves.

    Return by how much each joint or axis has moved, in units of what may stray; None: nothing has.
    """
    for which in mover.poses:
        mover.go_near(which)
        before, numbers = _where(probe, part)
        speed = min(SLOW, mover.speed)
        request_change(probe, request_of(probe.command, chosen, direction, speed))
        began = probe.device.connection.now
        _under_way(probe, mover, part, before)
        after = _stopped(probe, mover, part, probe.device.connection.now - began)
        moved = [now - then for now, then in zip(after, before)]
        if any(abs(by) > STRAYS[number.unit] for by, number in zip(moved, numbers)):
            mover.prefer(which)
            way = _parts(probe)[1]
            wrong = _not_so(part, chosen, way, direction, numbers, moved)
            call = f"{probe.command.name}({part.name}={chosen}, {direction})"
            reason = f"{call}: expected {wrong}; it moved by {_short(moved)}"
            probe.expect(ARRIVES, not wrong, reason)
            return moved
    return None


def _under_way(probe: Probe, mover: Mover, part: Field, before: Sequence[float]) -> None:
    """Wait until a jog shows clearly, but not for long: it may be out of reach."""
    until = probe.device.connection.now + 4 * UNDER_WAY
    while probe.device.connection.now < until:
        mover.rest(POLL)
        now, numbers = _where(probe, part)
        if any(abs(a - b) > SHOWS * STRAYS[n.unit] for a, b, n in zip(now, before, numbers)):
            return


def _stopped(probe: Probe, mover: Mover, part: Field, seconds: float) -> Sequence[float]:
    """Stop, and return where the arm is then; expect that it stays there.

    In ``seconds`` it would move on by more than what is allowed to stray.
    """
    bare = (
        c for c in probe.device.table.commands if c.safety == "motion" and not c.request[0].fields
    )
    ending = next((c for c in bare if c.family == probe.command.family), None)
    if ending is None:
        _halt(probe)
    else:
        probe.device.request(ending.request_type())
    mover.rest(2 * UNDER_WAY)
    stopped, numbers = _where(probe, part)
    mover.rest(max(seconds, UNDER_WAY))
    later, _ = _where(probe, part)
    moved = any(abs(a - b) > STRAYS[n.unit] for a, b, n in zip(stopped, later, numbers))
    _halt(probe)
    resume(probe)
    probe.expect(STOPS, not moved, f"after a stop: at {stopped}, then at {later}")
    return stopped


def _halt(probe: Probe) -> None:
    stop = probe.device.command("stop")
    if stop is not None:
        probe.device.request(stop.request_type())


def _not_so(
    part: Field,
    chosen: int,
    way: Field,
    direction: int,
    numbers: tuple[Number, ...],
    moved: Sequence[float],
) -> str:
    """Describe the motion that was expected; empty if it happened."""
    far = [abs(by) > STRAYS[number.unit] for by, number in zip(moved, numbers)]
    label = part.labels[part.choices.index(chosen)].lower() if part.labels else ""
    if label and label not in [number.name for number in numbers]:
        turns = [number.unit == "degree" for number in numbers]
        right = any(far) and not any(f for f, turn in zip(far, turns) if not turn)
        return "" if right else "the end to turn in place"
    at = _place(part, chosen, numbers)
    if not far[at] or any(far[:at]) or any(far[at + 1 :]):
        return f"only {numbers[at].name} to move"
    # Jogging forward increases a coordinate; for a joint the edition defines only "clockwise".
    forward = "FORWARD" in way.labels and way.choices[way.labels.index("FORWARD")] == direction
    if "FORWARD" in way.labels and (moved[at] > 0) is not forward:
        return f"{numbers[at].name} to {'grow' if forward else 'fall'}"
    return ""


def _short(moved: Sequence[float]) -> str:
    return ", ".join(f"{by:.2f}" for by in moved)


def _off(numbers: tuple[Number, ...], wanted: Sequence[float], came: Sequence[float]) -> list[str]:
    return [
        f"{number.name}: expected {want:.2f}, is {have:.2f} {number.units}"
        for number, want, have in zip(numbers, wanted, came)
        if abs(want - have) > STRAYS[number.unit]
    ]


def _parts(probe: Probe) -> tuple[Field, Field]:
    shape = _shape(probe.command)
    assert shape is not None
    return shape


def _choices(probe: Probe, part: Field) -> Sequence[int]:
    """Return the axes, or the joints whose angles are reported: a waist has others."""
    number = part.cases[0].numbers[0]
    every = part.choices or range(number.minimum, number.maximum + 1)
    return every if part.labels else [each for each in every if each <= probe.device.table.joints]


def _where(probe: Probe, part: Field) -> tuple[Sequence[float], tuple[Number, ...]]:
    """Return the position of the joints or of the end, whichever has the part; and its numbers."""
    query = probe.device.command("coordinates" if part.labels else "joints")
    reply = None if query is None else probe.device.read(query.request_type())
    if query is None or reply is None:
        raise NotSupported("no query reports where the arm is")
    return tuple(reply.result), query.reply[0].fields[0].cases[0].numbers


def _place(part: Field, chosen: int, numbers: tuple[Number, ...]) -> int:
    """Return which of the numbers a part is: by its label, or counted from one."""
    names = [number.name for number in numbers]
    labels = [label.lower() for label in part.labels]
    label = labels[part.choices.index(chosen)] if labels else ""
    return names.index(label) if label in names else chosen - 1


COORDINATES = Group(
    "single coordinates",
    (ARRIVES, *AFTER_CHANGE),
    _to_coordinates,
    _moves_one_axis,
    sends="A target a short distance up and down along or about each axis.",
    subject="the command that moves the end to one coordinate",
)
STEPS = Group(
    "steps",
    (ARRIVES, *AFTER_CHANGE),
    _step,
    _is_step,
    sends="A step up and down for each joint or axis.",
    subject="each motion by a distance",
)
JOGS = Group(
    "jogs",
    (ARRIVES, STOPS, *AFTER_CHANGE),
    _jogs,
    _is_jog,
    sends="A short jog in both directions for each joint or axis, and a stop.",
    subject="each motion in a direction",
)
