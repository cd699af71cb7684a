"""What a command sets is among the numbers of the query that reports it.

Some queries report several numbers of one kind, and no source says which of them the command sets.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from cobotwire.conformance.device.device import NotSupported
from cobotwire.conformance.device.groups.changes import AFTER_CHANGE, request_change
from cobotwire.conformance.device.probe import Probe
from cobotwire.conformance.suite import Group, TestCase
from cobotwire.protocol.table import Command, Field, Table

AMONG = TestCase("set-is-reported", "One of the numbers that the query reports is what was set.")

# The values that are set, as shares of the range.
SHARES = (0.3, 0.7)
SET, GET = "set_", "get_"


def is_shown(table: Table, command: Command) -> bool:
    """Return whether a command sets one of the numbers that the query of the same name reports."""
    return command.safety == "setting" and _query(table, command) is not None


def _query(table: Table, command: Command) -> Command | None:
    """Return the query: each of its numbers has the unit of the only argument of the command."""
    if command.read_by is not None or not command.name.startswith(SET):
        return None
    given = _units(command.request[0].fields)
    for query in table.commands:
        same = query.name == GET + command.name.removeprefix(SET) and query.safety == "query"
        if same and query.reply and not query.request[0].fields:
            shown = _units(query.reply[0].fields)
            if len(given) == 1 < len(shown) and given[0] and set(shown) == set(given):
                return query
    return None


def _units(fields: tuple[Field, ...]) -> list[str]:
    """Return the unit of each field; nothing if a field has a row."""
    if any(field.many for field in fields):
        return []
    return [field.cases[0].numbers[0].unit for field in fields]


def _set(probe: Probe) -> None:
    """Set two values, and read after each; then restore what was read before."""
    device, command = probe.device, probe.command
    query = _query(device.table, command)
    assert query is not None, "the group selects commands with a query"
    before = set(device.require(query.request_type()).fields.values())
    if len(before) != 1:
        raise NotSupported(f"{query.name} reports several numbers; which one is set is unknown")
    device.restore_after_body[command.name] = partial(device.request, _to(command, *before))
    number = command.request[0].fields[0].cases[0].numbers[0]
    for share in SHARES:
        raw = number.minimum + round(share * (number.maximum - number.minimum))
        value = number.physical(raw)
        request_change(probe, _to(command, value))
        shown = device.require(query.request_type()).fields
        reason = f"{command.name}({value:g}): expected {query.name} to report it; came {shown}"
        probe.expect(AMONG, value in shown.values(), reason)


def _to(command: Command, value: Any) -> Any:
    return command.request_type.from_fields({command.request[0].fields[0].name: value})


SHOWN_AMONG = Group(
    "set among others",
    (AMONG, *AFTER_CHANGE),
    _set,
    is_shown,
    sends="Two values, and the query after each.",
    subject="each setting whose query reports several numbers, without saying which one is set",
)
