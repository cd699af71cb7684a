"""End, resume and repeat runs on an arm that shares no code with the package."""

from __future__ import annotations

import contextlib

from cobotwire.conformance import Cause, Verdict
from cobotwire.conformance.device import DeviceConnection, Plan, Tester
from cobotwire.conformance.reports import from_json, to_json
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import LinkError
from cobotwire.simulator import SimulatedArm, TcpServer
from cobotwire.simulator.clock import SteppedClock
from cobotwire.transport import open_transport
from conformance.device.testing import on_peer, permissions
from defects.arm.planted import arm_with


def prepared_for(defect: str = "", *allow: str) -> Tester:
    clock = SteppedClock()
    return on_peer(arm_with(clock, defect), clock, TABLE, permissions=permissions(*allow))


def test_run_with_a_forgetful_arm_restores_what_it_has_set() -> None:
    run = prepared_for("forgets-after-noise", "setting", "malformed")
    run.run()
    assert run.device.restore_at_end == {}
    assert run.device.require(TABLE.command("get_speed").request_type()).result == 50


def test_arm_that_stops_replying_ends_the_run_at_once() -> None:
    run = prepared_for("dies", "setting", "malformed")
    report = run.run()
    assert not report.finished
    assert "does not reply to 3 queries in a row" in report.stopped
    assert run.connection.now < 20
    left = [result for result in report.results if result.cause is Cause.RUN_ENDED]
    assert ("agrees", "get_encoders") in {(r.case, r.command) for r in left}
    assert {r.reason for r in left} == {f"{report.stopped}."}


def test_resumed_run_runs_only_what_is_left_and_has_the_same_results() -> None:
    uninterrupted = prepared_for("", "setting")
    whole = uninterrupted.run()
    first = prepared_for("dies", "setting").run()
    again = prepared_for("", "setting")
    ended = again.run(plan=Plan(from_json(to_json(first)), resume=True))
    assert ended.finished
    assert [(r.group, r.outcome, r.case, r.command) for r in ended.results] == [
        (r.group, r.outcome, r.case, r.command) for r in whole.results
    ]
    # Requests of the first run are not sent again.
    assert again.connection.mark < uninterrupted.connection.mark - 50


def test_repeated_run_keeps_the_order_of_the_report() -> None:
    report = prepared_for().run()
    report.results.reverse()
    again = prepared_for().run(plan=Plan(from_json(to_json(report))))
    order = list(dict.fromkeys((r.group, r.command) for r in report.results))
    assert list(dict.fromkeys((r.group, r.command) for r in again.results)) == order


def test_connection_that_is_lost_ends_the_run_and_the_rest_is_not_run() -> None:
    with TcpServer(lambda: SimulatedArm(TABLE)) as server:
        transport = open_transport(server.url, TABLE.baudrate)
        run = Tester(DeviceConnection(transport), TABLE)

        def progress(_: object, index: int, count: int) -> None:
            if index == 20:
                server.stop()

        with contextlib.suppress(LinkError):
            run.run(progress)
        transport.close()
    assert run.report.stopped
    assert any(result.cause is Cause.RUN_ENDED for result in run.report.results)
    assert any(result.verdict is Verdict.PASS for result in run.report.results)
