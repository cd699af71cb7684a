"""An arm that shares no code with the package: correct, it passes; each defect is named."""

from __future__ import annotations

import contextlib
import subprocess
import sys
import time
from collections.abc import Callable

import pytest

import vectors
from cobotwire.conformance import Cause, Report, Verdict
from cobotwire.conformance.device import DeviceConnection, Plan, Tester
from cobotwire.conformance.reports import from_json, to_json
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import LinkError
from cobotwire.simulator.clock import SteppedClock
from cobotwire.simulator.memory import MemoryTransport
from cobotwire.transport import open_transport
from conformance.device.testing import permissions
from conformance.independent.arm import Arm


def prepared_for(*defects: str, allow: tuple[str, ...] = ()) -> Tester:
    clock = SteppedClock()
    connection = DeviceConnection(MemoryTransport(Arm(clock, *defects), clock), clock)
    return Tester(connection, TABLE, permissions=permissions(*allow))


def report_of(*defects: str, allow: tuple[str, ...] = ()) -> Report:
    return prepared_for(*defects, allow=allow).run()


def places(report: Report) -> set[tuple[str, str]]:
    return {(result.case, result.command) for result in report.failures}


def reason(report: Report, case: str, command: str) -> str:
    [found] = [r for r in report.failures if (r.case, r.command) == (case, command)]
    return found.reason


def test_correct_arm_conforms() -> None:
    report = report_of(allow=("setting", "persistent-write", "power", "malformed"))
    assert report.failures == []
    assert report.conforms


def test_settings_lost_after_a_wrong_len_are_named_with_the_request() -> None:
    report = report_of("forgets settings after a wrong LEN", allow=("setting", "malformed"))
    assert {case for case, _ in places(report)} == {"state-kept"}
    first = report.failures[0]
    assert "after LEN one too small, is_power_on (FE FE 01 12 FA): expected" in first.reason or (
        "after one data byte too many, and LEN with it, is_power_on (FE FE 03 12 00 FA)"
        in first.reason
    )
    assert "get_tool_reference()" in first.reason


@pytest.mark.parametrize("why", ["id", "footer", "cut"])
def test_single_setting_lost_after_other_malformed_requests_is_named(why: str) -> None:
    report = report_of(f"forgets the speed after a wrong {why}", allow=("setting", "malformed"))
    assert {case for case, _ in places(report)} == {"state-kept"}
    assert all("get_speed() to stay" in failure.reason for failure in report.failures)


def test_run_with_a_forgetful_arm_restores_what_it_has_set() -> None:
    run = prepared_for("forgets the speed after a wrong id", allow=("setting", "malformed"))
    run.run()
    assert run.device.restore_at_end == {}
    speed = TABLE.command("get_speed")
    assert run.device.require(speed.request_type()).result == 50


def test_acknowledged_colour_is_found_with_the_permission_for_settings() -> None:
    report = report_of("acknowledges the colour", allow=("setting",))
    assert places(report) == {("one-way-silent", "set_color")}


# What queries prove: the defect, and the test cases and commands that fail.
QUERIES = {
    "swaps joints 1 and 2": {
        ("agrees", "get_encoders"),
        ("geometry", "get_coords"),
        ("reached", "is_in_position"),
    },
    "sends angles in tenths": {
        ("agrees", "get_encoders"),
        ("geometry", "get_coords"),
        ("reached", "is_in_position"),
    },
    "sends coordinates in hundredths": {
        ("geometry", "get_coords"),
        ("reached", "is_in_position"),
    },
    "sends limits in degrees": {
        ("limits", "get_joint_min_angle"),
        ("limits", "get_joint_max_angle"),
    },
}


@pytest.mark.parametrize("defect", QUERIES)
def test_wrong_scale_or_order_is_found_by_queries_alone(defect: str) -> None:
    assert places(report_of(defect)) == QUERIES[defect]


@pytest.mark.parametrize(
    "defect", ["takes the tool in tenths of its length", "swaps the axes of the tool"]
)
def test_wrong_scale_or_axes_of_a_reference_are_found_without_motion(defect: str) -> None:
    report = report_of(defect, allow=("setting",))
    assert places(report) == {("reference-shifts", "set_tool_reference")}


def test_stale_reply_is_called_stale() -> None:
    report = report_of("replies with the angles before", allow=("motion", "power"))
    assert "get_angles is stale" in reason(report, "arrives", "send_angles")


def test_arm_that_stops_replying_ends_the_run_at_once() -> None:
    run = prepared_for("dies", allow=("setting", "malformed"))
    report = run.run()
    assert not report.finished
    assert "does not reply to 3 queries in a row" in report.stopped
    assert run.connection.now < 10
    left = [result for result in report.results if result.cause is Cause.RUN_ENDED]
    assert ("read-back", "set_tool_reference") in {(r.case, r.command) for r in left}
    assert {r.reason for r in left} == {f"{report.stopped}."}


def test_resumed_run_runs_only_what_is_left_and_has_the_same_results() -> None:
    alone = prepared_for(allow=("setting",))
    whole = alone.run()
    first = prepared_for("dies", allow=("setting",)).run()
    again = prepared_for(allow=("setting",))
    ended = again.run(plan=Plan(from_json(to_json(first)), resume=True))
    assert ended.finished
    assert [(r.group, r.outcome, r.case, r.command) for r in ended.results] == [
        (r.group, r.outcome, r.case, r.command) for r in whole.results
    ]
    # What the first run had done is not sent again.
    assert again.connection.mark < alone.connection.mark - 50


def test_repeated_run_keeps_the_order_of_the_report() -> None:
    report = report_of()
    report.results.reverse()
    again = prepared_for().run(plan=Plan(from_json(to_json(report))))
    order = list(dict.fromkeys((r.group, r.command) for r in report.results))
    assert list(dict.fromkeys((r.group, r.command) for r in again.results)) == order


def test_killed_device_is_noticed_and_the_rest_is_not_run() -> None:
    program = vectors.ROOT / "tests" / "conformance" / "independent" / "arm.py"
    with subprocess.Popen(
        [sys.executable, str(program)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        port = process.stdout.readline().strip()
        transport = open_transport(f"socket://127.0.0.1:{port}", TABLE.baudrate)
        run = Tester(DeviceConnection(transport), TABLE)
        began = time.monotonic()
        with contextlib.suppress(LinkError):
            run.run(_kill_at(20, process.kill))
        assert time.monotonic() - began < 60
        transport.close()
    assert run.report.stopped
    assert any(result.cause is Cause.RUN_ENDED for result in run.report.results)
    assert any(result.verdict is Verdict.PASS for result in run.report.results)


def _kill_at(step: int, kill: Callable[[], None]) -> Callable[[object, int, int], None]:
    def progress(_: object, index: int, count: int) -> None:
        if index == step:
            kill()

    return progress
