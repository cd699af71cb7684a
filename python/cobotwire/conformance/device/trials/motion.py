"""Motion inside the workspace: the arm arrives, says so, stops, and stays."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import (
    ACKNOWLEDGED,
    ARRIVES,
    MOVING,
    REACHED,
    SILENT,
    STOPS,
)
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.mover import ANGLE_TOLERANCE, Mover, Pose, off_by
from cobotwire.conformance.device.readable import Readable, Values, readable
from cobotwire.conformance.device.trial import Applies, Case, trial
from cobotwire.conformance.device.trials.orders import order
from cobotwire.session.motion import kind_of
from cobotwire.table import Command, Role, Table

# How far what is read may be from what was sent, by unit: a tick, and what the end does in one.
NEAR = {"degree": ANGLE_TOLERANCE, "millimetre": 1.5, "tick": 1.0, "percent": 1.0}
# Long enough to be heard moving, short enough not to have arrived, in seconds.
UNDER_WAY = 0.1


def _has(role: Role) -> Applies:
    return lambda table, command: command.role == role


@trial(ARRIVES, REACHED, MOVING, SILENT, ACKNOWLEDGED, of=_has("joint targets"))
def to_poses(case: Case) -> None:
    """All joints at once, from pose to pose."""
    mover = Mover(case)
    for which in (0, 1):
        pose, other = mover.pose(which), mover.pose(1 - which)
        mover.go(other)
        order(case, case.command, (pose, mover.speed))
        _says_moving(case, mover, True)
        mover.wait()
        wrong = off_by(mover.angles(), pose)
        case.expect(ARRIVES, not wrong, f"{case.command.name}: {'; '.join(wrong)}")
        _says_moving(case, mover, False)
        _says_reached(case, pose, True)
        _says_reached(case, other, False)


@trial(ARRIVES, SILENT, ACKNOWLEDGED, of=_has("joint target"))
def to_angle(case: Case) -> None:
    """One joint after the other; the rest stay."""
    mover = Mover(case)
    stands, target = mover.pose(0), mover.pose(1)
    mover.go(stands)
    for at, angle in enumerate(target):
        order(case, case.command, (at + 1, angle, mover.speed))
        mover.wait()
        stands = (*stands[:at], angle, *stands[at + 1 :])
        wrong = off_by(mover.angles(), stands)
        call = f"{case.command.name}(joint {at + 1}, {angle} degree)"
        case.expect(ARRIVES, not wrong, f"{call}: {'; '.join(wrong)}")


def is_replayed(table: Table, command: Command) -> bool:
    """Whether a motion's target is what a query tells."""
    sent = command.role in ("", "coordinate targets")
    return command.safety == "motion" and sent and bool(readable(table, command))


@trial(ARRIVES, SILENT, ACKNOWLEDGED, of=is_replayed)
def replay(case: Case) -> None:
    """Send what was read at another pose: the arm is there again, and reads the same."""
    mover = Mover(case)
    for motion in readable(case.bench.table, case.command):
        for key in motion.keys:
            for target in _targets(case, mover, motion, key):
                _replay(case, mover, motion, key, target)


def _targets(case: Case, mover: Mover, motion: Readable, key: Values) -> list[Values]:
    """What is read at the first pose; or any value, where the pose does not show in it."""
    found = []
    for which in (0, 1):
        mover.go(mover.pose(which))
        fields = case.bench.read(motion.query, motion.question(key))
        if fields is None:
            raise Unsupported(f"{motion.query.name} tells nothing")
        found.append(motion.told(fields))
    return found[:1] if found[0] != found[1] else motion.tries(key, found[0])


def _replay(case: Case, mover: Mover, motion: Readable, key: Values, target: Values) -> None:
    values, _ = motion.request({**motion.rest(mover.speed), **key}, target)
    order(case, case.command, values)
    mover.settle(lambda: case.bench.read(motion.query, motion.question(key)))
    fields = case.bench.read(motion.query, motion.question(key))
    got = None if fields is None else motion.told(fields)
    wrong = motion.differences(target, got, NEAR)
    case.expect(ARRIVES, not wrong, f"{case.command.name}: {'; '.join(wrong)}")


@trial(STOPS, MOVING, SILENT, ACKNOWLEDGED, of=_has("stop"))
def stopping(case: Case) -> None:
    """A stop on the way: the arm stands short of its target, and stays there."""
    mover = Mover(case)
    mover.go(mover.pose(0))
    case.bench.ask(mover.targets, (mover.pose(1), 1))
    mover.rest(UNDER_WAY)
    order(case, case.command, ())
    _says_moving(case, mover, False)
    stood = mover.angles()
    mover.rest(4 * UNDER_WAY)
    wrong = off_by(mover.angles(), stood)
    case.expect(STOPS, not wrong, f"behind {case.command.name}: {'; '.join(wrong)}")
    short = bool(off_by(stood, mover.pose(1)))
    case.expect(STOPS, short, f"{case.command.name}: expected the arm to stop on its way")
    resume(case)


def resume(case: Case) -> None:
    """Behind a stop some firmware ignores motion until it is told to go on."""
    for query in case.bench.table.commands:
        going = case.bench.switch(query, 0)
        if going is not None and going.safety == "motion" and query.safety == "query":
            case.bench.ask(going)


def _says_moving(case: Case, mover: Mover, moves: bool) -> None:
    query = case.bench.command("moving")
    if query is None:
        return
    if moves:
        mover.rest(UNDER_WAY)
    fields = case.bench.read(query)
    said = fields is not None and any(fields.values())
    reason = f"{query.name}: expected {moves}; came {fields}"
    case.expect(MOVING, fields is not None and said is moves, reason)


def _says_reached(case: Case, pose: Pose, there: bool) -> None:
    query = case.bench.command("reached")
    if query is None:
        return
    fields = case.bench.read(query, (pose, kind_of(case.bench.table, "ANGLES")))
    said = fields is not None and any(fields.values())
    reason = f"{query.name}{pose}: expected {there}; came {fields}"
    case.expect(REACHED, fields is not None and said is there, reason)
