"""The gripper goes where it is sent, opens and closes, and says when it moves."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import ACKNOWLEDGED, ARRIVES, MOVING, SILENT
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.mover import Mover
from cobotwire.conformance.device.readable import Readable, readable
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.motion import UNDER_WAY, is_replayed
from cobotwire.conformance.device.trials.orders import order
from cobotwire.table import Command, Table

# Slow enough to be heard moving, in percent of the fastest.
SLOW = 20
# The members that a state of a gripper is called by.
OPEN, CLOSE = "OPEN", "CLOSE"


def has_own_moving(table: Table, command: Command) -> bool:
    """Whether a family of its own tells that what a command moves is moving."""
    return is_replayed(table, command) and _moving(table, command) is not None


@trial(MOVING, of=has_own_moving)
def says_moving(case: Case) -> None:
    """On the way it moves; there it does not."""
    mover, motion = Mover(case), readable(case.bench.table, case.command)[-1]
    query = _moving(case.bench.table, case.command)
    assert query is not None
    for wanted in _ends(case, motion):
        values = motion.request(motion.rest(min(SLOW, mover.speed)), wanted)[0]
        case.bench.ask(case.command, values)
        mover.rest(UNDER_WAY)
        _says(case, query, True)
        mover.settle(lambda: case.bench.read(motion.query))
        _says(case, query, False)


def _ends(case: Case, motion: Readable) -> list[dict[str, object]]:
    """Two values that are far from each other, the one that is further away first."""
    old = motion.told(case.bench.read(motion.query) or {})
    tries = [motion.tries({}, old)[at] for at in (2, 3)]
    return tries if tries[0] != old else tries[::-1]


def _says(case: Case, query: Command, moves: bool) -> None:
    fields = case.bench.read(query)
    said = fields is not None and any(fields.values())
    case.expect(MOVING, said is moves, f"{query.name}: expected {moves}; came {fields}")


def _moving(table: Table, command: Command) -> Command | None:
    """The query of the command's family whose field is called as that of the arm's own query."""
    arm = next((c for c in table.commands if c.role == "moving"), None)
    names = [field.name for field in arm.reply[0].fields] if arm else []
    for query in _queries(table, command):
        if query is not arm and [field.name for field in query.reply[0].fields] == names:
            return query
    return None


def opens(table: Table, command: Command) -> bool:
    """Whether a command opens and closes what a query of its family tells in percent."""
    labels = command.request[0].fields[0].labels if command.request[0].fields else ()
    return {OPEN, CLOSE} <= set(labels) and _opening(table, command) is not None


@trial(ARRIVES, SILENT, ACKNOWLEDGED, of=opens)
def open_and_close(case: Case) -> None:
    """Open is wider than closed."""
    mover, query = Mover(case), _opening(case.bench.table, case.command)
    assert query is not None
    state = case.command.request[-1].fields[0]
    wide = {}
    for label in (OPEN, CLOSE, OPEN, CLOSE):
        order(case, case.command, (state.choices[state.labels.index(label)], mover.speed))
        mover.settle(lambda: case.bench.read(query))
        fields = case.bench.read(query)
        if fields is None:
            raise Unsupported(f"{query.name} tells nothing")
        wide[label] = next(iter(fields.values()))
    wider = wide[OPEN] > wide[CLOSE]
    case.expect(ARRIVES, wider, f"{case.command.name}: expected to be wider open; came {wide}")


def _opening(table: Table, command: Command) -> Command | None:
    for query in _queries(table, command):
        if query.reply[0].fields[0].cases[0].numbers[0].unit == "percent":
            return query
    return None


def _queries(table: Table, command: Command) -> list[Command]:
    """The queries of a command's family that a frame answers."""
    family = [query for query in table.commands if query.family == command.family]
    return [query for query in family if query.safety == "query" and query.reply]
