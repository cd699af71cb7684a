"""What a command switches, and what it leaves behind; and orders that nothing reads."""

from __future__ import annotations

from cobotwire.conformance.device.catalogue import (
    ACKNOWLEDGED,
    EFFECT,
    REPLIED,
    SILENT,
)
from cobotwire.conformance.device.ending import Unsupported
from cobotwire.conformance.device.mover import give_power
from cobotwire.conformance.device.readable import readable
from cobotwire.conformance.device.trial import Case, trial
from cobotwire.conformance.device.trials.motion import resume
from cobotwire.conformance.device.trials.orders import order
from cobotwire.conformance.device.values import gentle, requests
from cobotwire.table import Command, Table

# How long a switch may take to show, and how often it is looked at, in seconds.
SHOWS = 2.0
LOOK = 0.05


def switches(table: Table, command: Command) -> bool:
    """Whether a command brings about a fixed state that a query tells, and others end."""
    back = command.read_by
    return (
        back is not None
        and any(not isinstance(said, str) for _, said in back.fields)
        and command.safety != "persistent write"
    )


@trial(EFFECT, SILENT, ACKNOWLEDGED, REPLIED, of=switches)
def switch(case: Case) -> None:
    """Bring the other state about, then this one, then the one that was there."""
    assert case.command.read_by is not None
    if case.command.safety == "power":
        give_power(case.bench)
    query = case.bench.table.command(case.command.read_by.query)
    name, wanted = case.command.read_by.fields[0]
    fields = case.bench.read(query)
    if fields is None:
        raise Unsupported(f"{query.name} tells nothing")
    before = int(fields[name])
    back = case.bench.switch(query, 1 - int(wanted)) if wanted in (0, 1) else None
    if back is None and before != wanted and "irreversible" not in case.bench.leave.classes:
        raise Unsupported("no command switches it back, and there is no leave for irreversible")
    undo = back if before != wanted else case.command
    if undo is not None:
        case.bench.undo[case.command.name] = lambda: _send(case, undo)
    if back is not None and before == wanted:
        _send(case, back)
    _send(case, case.command)
    said = _await(case, query, name, int(wanted))
    call = case.command.name
    case.expect(EFFECT, said == wanted, f"{call}: expected {query.name} to say {wanted}; {said}")


def _send(case: Case, command: Command) -> None:
    """Send a command for each joint that it may be for."""
    for values in requests(command.request[-1], {}, dict(*command.tries[-1:])):
        order(case, command, values)


def _await(case: Case, query: Command, name: str, wanted: int) -> int | None:
    """What a query says, as soon as it is what is wanted; else what it says at the end."""
    until = case.bench.line.now + SHOWS
    while True:
        fields = case.bench.read(query)
        said = None if fields is None else int(fields[name])
        if said == wanted or case.bench.line.now >= until:
            return said
        case.bench.line.clock.sleep(LOOK)


def is_blind(table: Table, command: Command) -> bool:
    """Whether nothing reads what a command does, and nothing sets it back."""
    return (
        command.safety != "query"
        and not command.role
        and not switches(table, command)
        and not readable(table, command)
        and not (command.read_by is not None and command.safety == "persistent write")
    )


@trial(SILENT, ACKNOWLEDGED, REPLIED, of=is_blind, leave=("irreversible",))
def blind(case: Case) -> None:
    """Send it once, with the mildest arguments, and judge what comes."""
    text = case.command.request_text
    words = None if text is None else dict.fromkeys(text.fields, "cobot")
    order(case, case.command, gentle(case.command.request[-1]), words)
    stop = case.bench.command("stop")
    if case.command.safety == "motion" and stop is not None:
        case.bench.ask(stop)
        resume(case)
