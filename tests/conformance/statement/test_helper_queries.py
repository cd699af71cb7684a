"""No test case sends or needs a command that the device lacks."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest

from cobotwire.conformance.device import Tester
from cobotwire.conformance.statement import Statement, Support, is_mandatory
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator.clock import SteppedClock
from conformance.device.testing import on_peer
from defects.arm.planted import arm_with
from defects.devices import LEFT_OUT

CAN_LACK = [c for c in TABLE.commands if not is_mandatory(c) and c.name not in LEFT_OUT]
ALL_QUERIES = [command for command in CAN_LACK if command.safety == "query"]
# A device that lacks only some commands may have just one of two that refer to each other.
QUERIES = {f"queries, share {at}": ALL_QUERIES[at::4] for at in range(4)}
LACKED = {
    "all": CAN_LACK,
    "all queries": ALL_QUERIES,
    **QUERIES,
    **{f"share {at}": CAN_LACK[at::4] for at in range(4)},
}


def _lacks(ids: set[int], right: Callable[[int, bytes], bytes], id: int, data: bytes) -> bytes:
    return b"" if id in ids else right(id, data)


def _run(lacked: str, support: Support) -> Tester:
    """Run all steps but those that test the statement, on an arm that lacks commands."""
    absent = LACKED[lacked]
    statement = Statement(
        edition=TABLE.edition, commands={command.name: support for command in absent}
    )
    clock = SteppedClock()
    arm = arm_with(clock)
    ids = {command.id for command in absent} - {c.id for c in TABLE.commands if c not in absent}
    arm.reply = partial(_lacks, ids, arm.reply)  # type: ignore[method-assign]
    tester = on_peer(arm, clock, TABLE, statement=statement)
    for step in tester.steps():
        if not step.group.declared and (step.command is None or step.command.name not in LEFT_OUT):
            tester.report.results += tester.results(step)
    tester.end()
    return tester


@pytest.mark.parametrize("lacked", LACKED)
def test_command_declared_absent_is_never_sent_nor_needed(lacked: str) -> None:
    tester = _run(lacked, Support.ABSENT)
    assert [str(result) for result in tester.report.failures] == []
    sent = {each.note.partition("(")[0] for each in tester.connection.last_sent(10**6)}
    assert not sent & {command.name for command in LACKED[lacked]}


@pytest.mark.parametrize("lacked", ["all queries", *QUERIES])
def test_query_declared_optional_is_not_needed(lacked: str) -> None:
    tester = _run(lacked, Support.OPTIONAL)
    assert [str(result) for result in tester.report.failures] == []
