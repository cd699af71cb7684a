"""The simulated arm of every edition conforms: in stepped time, on a pseudo-terminal, over TCP."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cobotwire import editions
from cobotwire.cli.shared.subject_connection import Lacking
from cobotwire.conformance import Report, Verdict
from cobotwire.conformance.device import ALL_PERMISSIONS, DeviceConnection, Step, Tester
from cobotwire.protocol.table import Table
from cobotwire.simulator import PtyServer, Server, SimulatedArm, TcpServer
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.transport import open_transport
from conformance.device.testing import permissions


def _whole_run(table: Table, address: str | None = None) -> Report:
    clock, lacking = SteppedClock(), Lacking(table)
    arm = SimulatedArm(table, clock=clock, on_note=lacking.note)
    tester = Tester(
        DeviceConnection(MemoryTransport(arm, clock), clock),
        table,
        permissions=permissions(*ALL_PERMISSIONS, joints=table.joints),
        address=address,
        lacking=lacking.reasons,
    )
    return tester.run()


@pytest.mark.parametrize("edition", editions.names())
def test_simulated_arm_of_an_edition_conforms(edition: str) -> None:
    table = editions.load(edition).TABLE
    report = _whole_run(table)
    assert [(r.case, r.command, r.reason) for r in report.failures] == []
    assert report.finished
    passed = sum(result.verdict is Verdict.PASS for result in report.results)
    inconclusive = sum(result.verdict is Verdict.INCONCLUSIVE for result in report.results)
    # Without a geometry, queries of coordinates are silent; the myBuddy has the most of them.
    assert passed > (7 if edition == "mybuddy" else 8) * inconclusive
    assert passed > 3 * len(table.commands)


def _on_a_port(table: Table, optional: frozenset[str]) -> Report:
    """Run everything on an arm that states nothing, as through a port."""
    clock = SteppedClock()
    tester = Tester(
        DeviceConnection(MemoryTransport(SimulatedArm(table, clock=clock), clock), clock),
        table,
        permissions=permissions(*ALL_PERMISSIONS, joints=table.joints),
        optional=optional,
    )
    return tester.run()


@pytest.mark.parametrize("edition", ["mypalletizer260", "pro450"])
def test_silence_of_a_query_fails_once_and_option_excuses_it(edition: str) -> None:
    table = editions.load(edition).TABLE
    failures = _on_a_port(table, frozenset()).failures
    assert "get_coords" in {result.command for result in failures}
    assert {result.case for result in failures} == {"query-replied"}
    silent = frozenset(result.command for result in failures)
    assert len(failures) == len(silent)
    assert _on_a_port(table, silent).failures == []


@pytest.mark.parametrize("address", ["LEFT", "RIGHT", "WAIST"])
def test_single_limb_of_a_robot_with_three_conforms(address: str) -> None:
    report = _whole_run(editions.load("mybuddy").TABLE, address)
    assert [(r.case, r.command, r.reason) for r in report.failures] == []


SERVERS: dict[str, Callable[[SimulatedArm], Server]] = {
    "pty": PtyServer,
    "tcp": lambda arm: TcpServer(lambda: arm),
}


@pytest.mark.parametrize("edition", editions.names())
@pytest.mark.parametrize("kind", SERVERS)
def test_real_line_to_an_edition_has_replies(edition: str, kind: str) -> None:
    table = editions.load(edition).TABLE
    with SERVERS[kind](SimulatedArm(table)) as server:
        transport = open_transport(server.url, table.baudrate)
        try:
            # A busy machine may delay a reply.
            tester = Tester(DeviceConnection(transport), table, retries=3)
            for step in _short(tester):
                for result in tester.results(step):
                    assert result.verdict is Verdict.PASS, (result.case, result.reason)
        finally:
            transport.close()


def _short(tester: Tester) -> list[Step]:
    """Return the queries of the joints and whether they move."""
    roles = ("joints", "moving", "version")
    steps = (step for step in tester.steps() if step.group.name == "queries")
    return [step for step in steps if step.command and step.command.role in roles]
