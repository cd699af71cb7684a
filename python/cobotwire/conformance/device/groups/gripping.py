"""The gripper opens and closes, and reports that it moves."""

from __future__ import annotations

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.motion import ARRIVES, MOVING, UNDER_WAY, is_replayed
from cobotwire.conformance.device.mover import Mover
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.read_back import Setting, settings_of
from cobotwire.conformance.suite import Group
from cobotwire.protocol.table import Command, Table

# Slow enough to be reported as moving, in percent of the fastest.
SLOW = 20
# The names of the gripper's states.
OPEN, CLOSE = "OPEN", "CLOSE"


def _has_own_moving(table: Table, command: Command) -> bool:
    """Return whether a query of the command's family reports that what it moves is moving."""
    return is_replayed(table, command) and _moving(table, command) is not None


def _reports_moving(probe: Probe) -> None:
    """Expect the query to report motion on the way, and no motion at the target."""
    mover, motion = Mover(probe), settings_of(probe.device.table, probe.command)[-1]
    query = _moving(probe.device.table, probe.command)
    assert query is not None
    for wanted in _ends(probe, motion):
        values = motion.request(motion.rest(min(SLOW, mover.speed)), wanted)[0]
        probe.device.request(probe.command, values)
        mover.rest(UNDER_WAY)
        _expect_moving(probe, query, True)
        mover.settle(lambda: probe.device.read(motion.query))
        _expect_moving(probe, query, False)


def _ends(probe: Probe, motion: Setting) -> list[dict[str, object]]:
    """Return two values far from each other, the more distant one first."""
    fields = probe.device.read(motion.query)
    if fields is None:
        raise NotSupported(f"{motion.query.name} reports nothing")
    old = motion.reported(fields)
    ends = motion.samples({}, old)[2:4]
    return ends if ends[0] != old else ends[::-1]


def _expect_moving(probe: Probe, query: Command, moves: bool) -> None:
    reported = bool(probe.device.is_set(query))
    probe.expect(MOVING, reported is moves, f"{query.name}: expected {moves}; came {reported}")


def _moving(table: Table, command: Command) -> Command | None:
    """Return the query of the family that has the same field as the arm's own query."""
    arm = next((c for c in table.commands if c.role == "moving"), None)
    names = [field.name for field in arm.reply[0].fields] if arm else []
    for query in _queries(table, command):
        if query is not arm and [field.name for field in query.reply[0].fields] == names:
            return query
    return None


def _opens(table: Table, command: Command) -> bool:
    """Return whether a command opens what a query of its family reports in percent."""
    labels = command.request[0].fields[0].labels if command.request[0].fields else ()
    return {OPEN, CLOSE} <= set(labels) and _opening(table, command) is not None


def _open_and_close(probe: Probe) -> None:
    """Expect open to be wider than closed."""
    mover, query = Mover(probe), _opening(probe.device.table, probe.command)
    assert query is not None
    state = probe.command.request[-1].fields[0]
    wide = {}
    for label in (OPEN, CLOSE, OPEN, CLOSE):
        request_change(
            probe, probe.command, (state.choices[state.labels.index(label)], mover.speed)
        )
        mover.settle(lambda: probe.device.read(query))
        fields = probe.device.read(query)
        if fields is None:
            raise NotSupported(f"{query.name} reports nothing")
        wide[label] = next(iter(fields.values()))
    wider = wide[OPEN] > wide[CLOSE]
    probe.expect(ARRIVES, wider, f"{probe.command.name}: expected open to be wider; came {wide}")


def _opening(table: Table, command: Command) -> Command | None:
    for query in _queries(table, command):
        if query.reply[0].fields[0].cases[0].numbers[0].unit == "percent":
            return query
    return None


def _queries(table: Table, command: Command) -> list[Command]:
    """Return the queries of a command's family that have a framed reply."""
    family = [query for query in table.commands if query.family == command.family]
    return [query for query in family if query.safety == "query" and query.reply]


GRIPPER_MOVES = Group("gripper moves", (MOVING,), _reports_moving, _has_own_moving)
GRIPPER_OPENS = Group("gripper opens", (ARRIVES, *AFTER_CHANGE), _open_and_close, _opens)
