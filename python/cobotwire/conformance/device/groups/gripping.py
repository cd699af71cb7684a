"""The gripper opens and closes, and reports that it moves."""

from __future__ import annotations

from typing import Any

from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.motion import (
    ARRIVED,
    ARRIVES,
    MOVING,
    NEAR,
    Motion,
    expect_on_the_way,
    expect_rest,
    is_replayed,
)
from cobotwire.conformance.device.mover import Mover, Pose
from cobotwire.conformance.device.probe import Probe, for_found
from cobotwire.conformance.device.read_back import settings_of
from cobotwire.conformance.device.requests import as_row
from cobotwire.conformance.device.selection import does, reporter, reporters
from cobotwire.conformance.suite import Group
from cobotwire.protocol.effects import Cases, Moves
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table

# Slow enough to be reported as moving, in percent of the highest speed.
SLOW = 20


def _moving(table: Table, command: Command) -> Command | None:
    """Return the query without the role ``moving`` that reports whether the gripper moves."""
    motion = does(Moves)(table, command)
    if motion is None or not is_replayed(table, command):
        return None
    found = reporters(table, "gripper_moving" if motion.part == "gripper" else "moving")
    return next((each.query for each in found if each.query.role != "moving"), None)


def _reports_moving(probe: Probe, moving: Command) -> None:
    """Expect the query to report motion on the way, and no motion at the target."""
    mover, motion = Mover(probe.device), settings_of(probe.device.table, probe.command)[-1]
    position, (reported, argument) = motion.query.request_type(), motion.pairs[0]
    old = probe.device.require(position)
    here, observed = as_row(old.fields[reported]), []

    def distance(target: Request[Any]) -> float:
        pairs = zip(as_row(target.fields[argument]), here)
        return max(abs(float(one) - float(other)) for one, other in pairs)

    def place() -> Pose | None:
        reply = probe.device.read(position)
        return None if reply is None else as_row(reply.fields[reported])

    between = motion.samples(position, old, min(SLOW, mover.speed))[:2]
    for target in sorted(between, key=distance, reverse=True):
        start, end = place() or here, as_row(target.fields[argument])
        probe.device.request(target)
        way = Motion(place, start, end, NEAR["percent"])
        observed.append(expect_on_the_way(probe, moving, way))
        mover.settle(lambda: probe.device.read(position))
        expect_rest(probe, moving)
    if not any(observed):
        probe.not_timed(MOVING, ARRIVED)


def opens(table: Table, command: Command) -> Cases | None:
    """Return the cases of a command that open and close a gripper, if a query reads its opening."""
    cases = does(Cases)(table, command)
    shown = reporter(table, "opening") is not None
    return cases if cases and shown and len(_openings(cases)) > 1 else None


def _openings(cases: Cases) -> dict[float, tuple[int, Moves]]:
    """Return the value of the selector and the motion for each opening, in percent."""
    return {
        case.to: (raw, case)
        for raw, case in cases.cases.items()
        if isinstance(case, Moves) and case.part == "gripper" and isinstance(case.to, int | float)
    }


def _open_and_close(probe: Probe, cases: Cases) -> None:
    """Expect open to be wider than closed."""
    mover, opening = Mover(probe.device), reporter(probe.device.table, "opening")
    assert opening is not None, "the group selects editions with it"
    position, wide, openings = opening.query.request_type(), dict[str, Any](), _openings(cases)
    for label, wanted in 2 * (("open", max(openings)), ("closed", min(openings))):
        raw, motion = openings[wanted]
        speed = {motion.speed: mover.speed} if motion.speed else {}
        fields = {cases.selector: raw, **speed}
        request_change(probe, probe.command.request_type.from_fields(fields))
        mover.settle(lambda: probe.device.read(position))
        wide[label] = probe.device.require(position).result
    wider = wide["open"] > wide["closed"]
    probe.expect(
        ARRIVES, wider, f"{probe.command.name}: expected open to be wider; received {wide}"
    )


GRIPPER_MOVES = Group(
    "gripper moves",
    (MOVING,),
    *for_found(_moving, _reports_moving),
    sends="Two positions of the gripper; whether it moves is read on the way and at the end.",
    subject="each motion of a gripper that a query reports as moving",
)
GRIPPER_OPENS = Group(
    "gripper opens",
    (ARRIVES, *AFTER_CHANGE),
    *for_found(opens, _open_and_close),
    sends="Open and close, twice; the opening is read after each.",
    subject="each command that opens and closes a gripper",
)
