"""What cannot be taken back: a place is called by a fixed number from now on."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import (
    ACKNOWLEDGED,
    EFFECT,
    NEIGHBOURS,
    REPLIED,
    SILENT,
)
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.mover import Mover
from cobotwire.conformance.device.readable import readable
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.orders import order
from cobotwire.conformance.device.values import requests
from cobotwire.table import Command, Table


def is_calibration(table: Table, command: Command) -> bool:
    """Whether a command fixes for good what a query tells."""
    back = command.read_by
    fixed = back is not None and any(not isinstance(said, str) for _, said in back.fields)
    return fixed and command.safety == "persistent write"


@trial(
    EFFECT, NEIGHBOURS, SILENT, ACKNOWLEDGED, REPLIED, of=is_calibration, leave=("irreversible",)
)
def calibrate(case: Case) -> None:
    """At a pose where nothing reads so: each part in turn; the others are as they were."""
    assert case.command.read_by is not None
    query = case.bench.table.command(case.command.read_by.query)
    [(name, wanted)] = case.command.read_by.fields
    form = case.command.request[-1]
    if not form.fields:
        case.without(NEIGHBOURS)
    if case.bench.leave.workspace:
        mover = Mover(case)
        mover.go(mover.pose(0))
        _set_off(case, mover, query)
    for part in requests(form, {}, dict(*case.command.tries[-1:])):
        before = _told(case, query, name)
        order(case, case.command, part)
        for asked, said in _told(case, query, name).items():
            mine = asked == part
            right = int(wanted) if mine else before[asked]
            reason = (
                f"behind {case.command.name}{part}: expected {query.name}{asked} to say {right}"
            )
            case.expect(EFFECT if mine else NEIGHBOURS, said == right, f"{reason}; came {said}")


def _told(case: Case, query: Command, name: str) -> dict[tuple[object, ...], object]:
    """What the query says of each part."""
    found: dict[tuple[object, ...], object] = {}
    for asked in requests(query.request[-1], {}):
        fields = case.bench.read(query, asked)
        if fields is None:
            raise Unsupported(f"{query.name} tells nothing")
        found[asked] = fields[name]
    return found


def _set_off(case: Case, mover: Mover, query: Command) -> None:
    """Where a motion sets what is calibrated, as a gripper's, it is away from its zero."""
    for command in case.bench.table.commands:
        if command.safety != "motion" or command.role or command.request[0].fields[1:] == ():
            continue
        for motion in readable(case.bench.table, command):
            if motion.query is query and not motion.keys[0]:
                values = motion.tries({}, motion.told(case.bench.read(query) or {}))[0]
                case.bench.ask(command, motion.request(motion.rest(mover.speed), values)[0])
                mover.settle(lambda: case.bench.read(query))
                return
