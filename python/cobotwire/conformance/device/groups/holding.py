"""Single joints are released and held again; the others stay as they are."""

from __future__ import annotations

from functools import partial
from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.groups.settings import NEIGHBOURS
from cobotwire.conformance.device.groups.switching import EFFECT
from cobotwire.conformance.device.mover import give_power
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.device.requests import arguments_of, harmless, request_of
from cobotwire.conformance.suite import Group
from cobotwire.protocol.messages import Request
from cobotwire.protocol.table import Command, Table, Variant


def _is_for_one(table: Table, command: Command) -> bool:
    """Return whether a command switches one part, and a query reports the state of each."""
    return _single(table, command) is not None and len(_parts(command)) > 1


def _switch_each(probe: Probe) -> None:
    """Set the opposite state for all parts, then the command's own for each part in turn."""
    single = _single(probe.device.table, probe.command)
    assert single is not None
    assert probe.command.read_by is not None
    give_power(probe.device)
    [(name, wanted)] = probe.command.read_by.fields
    back = _counterpart(probe, 1 - int(wanted))
    restore = partial(_send_to_all, probe, _counterpart(probe, 1))
    for part in _parts(probe.command):
        probe.device.restore_after_body[probe.command.name] = restore
        _send_to_all(probe, back)
        request_change(probe, part)
        call = f"{probe.command.name}({arguments_of(part)})"
        for other in _parts(probe.command):
            query = request_of(single, *other.values)
            value = int(getattr(probe.device.require(query), name))
            right = int(wanted) if other == part else 1 - int(wanted)
            reason = f"after {call}: expected {single.name}({arguments_of(query)}) to report"
            case = EFFECT if other == part else NEIGHBOURS
            probe.expect(case, value == right, f"{reason} {right}; came {value}")
        if not int(wanted):
            _expect_of_all(probe, name, call)


def _expect_of_all(probe: Probe, name: str, call: str) -> None:
    """Expect the query of all parts to report that one of them is switched off."""
    back = probe.command.read_by
    assert back is not None, "the group selects commands with a query"
    query = probe.device.table.command(back.query)
    value = int(getattr(probe.device.require(query.request_type()), name))
    reason = f"after {call}, while the others are on: expected {query.name} to report 0"
    probe.expect(EFFECT, value == 0, f"{reason}; came {value}")


def _single(table: Table, command: Command) -> Command | None:
    """Return the query that reports one part's state; the command's own query reports all."""
    if command.read_by is None or len(command.read_by.fields) != 1:
        return None
    reported, names = command.read_by.fields[0][0], _names(command.request[-1])
    for query in table.commands:
        if query.safety == "query" and query.name != command.read_by.query and names:
            fields = {field.name for variant in query.reply for field in variant.fields}
            if reported in fields and _names(query.request[0]) == names:
                return query
    return None


def _names(variant: Variant) -> list[str]:
    return [field.name for field in variant.fields]


def _parts(command: Command) -> list[Request[Any]]:
    return harmless(command)


def _counterpart(probe: Probe, wanted: int) -> Command:
    """Return the command that sets one part to the state ``wanted``."""
    for command in probe.device.table.commands:
        back = command.read_by if _is_for_one(probe.device.table, command) else None
        if back is not None and back.fields[0][1] == wanted:
            return command
    raise NotSupported("no command sets the opposite state")


def _send_to_all(probe: Probe, command: Command) -> None:
    for part in _parts(command):
        probe.device.request(part)


HOLDING = Group(
    "single parts",
    (EFFECT, NEIGHBOURS, *AFTER_CHANGE),
    _switch_each,
    _is_for_one,
    sends="The opposite state for all parts, then the command for each part in turn.",
    subject="each command that switches one part, if a query reports the state of each",
)
