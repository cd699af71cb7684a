"""Single joints are let go and held again; the others are as they were."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import ACKNOWLEDGED, EFFECT, NEIGHBOURS, SILENT
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.mover import give_power
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.orders import order
from cobotwire.conformance.device.values import requests
from cobotwire.table import Command, Layout, Table


def is_for_one(table: Table, command: Command) -> bool:
    """Whether a command switches a state of one part, and a query tells it of each part."""
    return _single(table, command) is not None and len(_parts(command)) > 1


@trial(EFFECT, NEIGHBOURS, SILENT, ACKNOWLEDGED, of=is_for_one)
def hold_one(case: Case) -> None:
    """The other state for all; this one for each part in turn; what was there for all."""
    single = _single(case.bench.table, case.command)
    assert single is not None
    assert case.command.read_by is not None
    give_power(case.bench)
    [(name, wanted)] = case.command.read_by.fields
    back = _counterpart(case, 1 - int(wanted))
    for part in _parts(case.command):
        case.bench.undo[case.command.name] = lambda: _send_all(case, _counterpart(case, 1))
        _send_all(case, back)
        order(case, case.command, part)
        for other in _parts(case.command):
            fields = case.bench.read(single, other)
            if fields is None:
                raise Unsupported(f"{single.name} tells nothing")
            said, right = int(fields[name]), int(wanted) if other == part else 1 - int(wanted)
            reason = f"behind {case.command.name}{part}: expected {single.name}{other} to say"
            rule = EFFECT if other == part else NEIGHBOURS
            case.expect(rule, said == right, f"{reason} {right}; came {said}")


def _single(table: Table, command: Command) -> Command | None:
    """The query that tells of one part what the command's own query tells of all."""
    if command.read_by is None or len(command.read_by.fields) != 1:
        return None
    told, names = command.read_by.fields[0][0], _names(command.request[-1])
    for query in table.commands:
        if query.safety == "query" and query.name != command.read_by.query and names:
            fields = {field.name for form in query.reply for field in form.fields}
            if told in fields and _names(query.request[0]) == names:
                return query
    return None


def _names(form: Layout) -> list[str]:
    return [field.name for field in form.fields]


def _parts(command: Command) -> list[tuple[object, ...]]:
    return requests(command.request[-1], {})


def _counterpart(case: Case, wanted: int) -> Command:
    """The command for one part that brings the other state about."""
    for command in case.bench.table.commands:
        back = command.read_by if is_for_one(case.bench.table, command) else None
        if back is not None and back.fields[0][1] == wanted:
            return command
    raise Unsupported("no command brings the other state about")


def _send_all(case: Case, command: Command) -> None:
    for part in _parts(command):
        case.bench.ask(command, part)
