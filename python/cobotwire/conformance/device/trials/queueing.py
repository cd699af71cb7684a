"""What becomes of a target when the next one comes while the arm is on its way."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import ACKNOWLEDGED, EFFECT, SILENT
from cobotwire.conformance.device.mover import Mover
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.orders import order
from cobotwire.table import Command, Table

# The members that the edition calls the two modes by.
QUEUED, NEWEST = "INTERPOLATION", "REFRESH"
# How far apart the targets are, how far the arm must have gone to show its way, in degrees, and how
# long that may take, in seconds.
WAY, SHOWN, LONGEST = 8.0, 1.0, 10.0
LOOK = 0.02


def queues(table: Table, command: Command) -> bool:
    """Whether a setting chooses between the two."""
    fields = command.request[0].fields
    return command.safety == "setting" and len(fields) == 1 and fields[0].labels == (QUEUED, NEWEST)


@trial(EFFECT, SILENT, ACKNOWLEDGED, of=queues, leave=("motion", "irreversible"))
def next_target(case: Case) -> None:
    """Joint 1 up, and at once down: it goes up first where targets are queued."""
    mover, mode = Mover(case), case.command.request[0].fields[0]
    case.bench.undo[case.command.name] = lambda: _back(case, mode.choices[0])
    pose = mover.pose(2)
    up, down = ((pose[0] + way, *pose[1:]) for way in (WAY, -WAY))
    for label in (NEWEST, QUEUED):
        order(case, case.command, (mode.choices[mode.labels.index(label)],))
        mover.go(pose)
        for target in (up, down):
            case.bench.ask(mover.targets, (target, mover.speed))
        went_up = _first_way(mover, pose[0]) > 0
        mover.wait()
        reason = f"{label}: expected joint 1 to go {'up' if label == QUEUED else 'down'} first"
        case.expect(EFFECT, went_up is (label == QUEUED), reason)


def _first_way(mover: Mover, start: float) -> float:
    """How far joint 1 has gone when it is away from where it started."""
    until = mover.bench.line.now + LONGEST
    while mover.bench.line.now < until:
        way = mover.angles()[0] - start
        if abs(way) > SHOWN:
            return way
        mover.rest(LOOK)
    return 0.0


def _back(case: Case, mode: int) -> None:
    """The mode that the edition names first."""
    case.bench.ask(case.command, (mode,))
