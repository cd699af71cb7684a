"""A statement selects test cases, and is itself tested."""

from __future__ import annotations

from functools import partial

import pytest

from cobotwire import editions
from cobotwire.conformance import Cause, Report, Verdict
from cobotwire.conformance.statement import Statement, read_statement
from cobotwire.simulator import SimulatedArm
from conformance.device.testing import permissions, prepared

TABLE = editions.load("mycobot280").TABLE
HEAD = "statement: 1\nedition: mycobot280\n"
# The edition of the manufacturer's document (mycobot) lacks these queries.
LACKING = ("get_tof_distance", "get_reboot_count")


def declared(text: str) -> Statement:
    return read_statement(HEAD + text, TABLE)


def outcomes(report: Report, command: str) -> set[str]:
    return {result.outcome for result in report.results if result.command == command}


def run(text: str, *allow: str, device: str = "mycobot280", acks: bool = True) -> Report:
    wrap = partial(_acknowledging, acks)
    table = editions.load(device).TABLE
    tester = prepared(
        TABLE, wrap, device=table, permissions=permissions(*allow), statement=declared(text)
    )
    names = [*LACKING, "get_angles", *(["get_gripper_value"] if device == "mycobot280" else [])]
    # The other steps would take seconds if the device implements another edition.
    steps = [
        step
        for step in tester.steps()
        if step.group.declared
        or step.group.name == "lights"
        or (step.command and step.command.name in names)
    ]
    for step in steps:
        tester.report.results += tester.results(step)
    return tester.report


def _acknowledging(acks: bool, arm: SimulatedArm) -> SimulatedArm:
    return arm if acks else SimulatedArm(arm.table, clock=arm.clock, acks=False)


def test_command_declared_absent_that_replies_fails_the_statement() -> None:
    report = run("commands: {get_tof_distance: absent}")
    [failure] = report.failures
    assert (failure.case, failure.command) == ("declared-absent", "get_tof_distance")
    assert "declared absent: expected no reply; received FE FE" in failure.reason
    others = [r for r in report.results if r.command == "get_tof_distance" and r is not failure]
    assert {r.cause for r in others} == {Cause.NOT_SELECTED}
    assert outcomes(report, "get_angles") == {"pass", "not run (not permitted)"}


def test_silent_command_fails_unless_it_is_declared_optional() -> None:
    report = run(f"commands: {{{LACKING[0]}: optional}}", device="mycobot")
    assert {(r.case, r.command) for r in report.failures} == {("query-replied", LACKING[1])}
    assert "inconclusive (not supported)" in outcomes(report, LACKING[0])


def test_setting_declared_absent_is_sent_with_the_value_that_it_has() -> None:
    report = run("commands: {set_fresh_mode: absent}", "setting")
    [failure] = [r for r in report.failures if r.case == "declared-absent"]
    assert failure.command == "set_fresh_mode"
    assert failure.evidence[-2].note.startswith("set_fresh_mode(")
    # Without the permission nothing is sent.
    report = run("commands: {set_fresh_mode: absent}")
    [result] = [r for r in report.results if r.case == "declared-absent"]
    assert result.outcome == "not run (not permitted)"


def test_commands_of_equipment_that_is_not_fitted_are_not_selected() -> None:
    report = run("fitted: {gripper: false}")
    assert outcomes(report, "get_gripper_value") == {"not run (not selected)"}
    assert report.failures == []


@pytest.mark.parametrize(("firmware", "right"), [("6.5", True), ("6.4", False)])
def test_declared_firmware_is_compared_with_the_reported_one(firmware: str, right: bool) -> None:
    report = run(f"firmware: '{firmware}'")
    [result] = [r for r in report.results if r.case == "declared-firmware"]
    assert result.verdict is (Verdict.PASS if right else Verdict.FAIL)
    assert right or "get_system_version reports 6.5" in result.reason


@pytest.mark.parametrize("word", ["all", "none"])
@pytest.mark.parametrize("acks", [True, False])
def test_declared_acknowledgements_are_compared_with_those_that_came(word: str, acks: bool) -> None:
    tester = prepared(
        TABLE,
        partial(_acknowledging, acks),
        permissions=permissions("setting"),
        statement=declared(f"acknowledgements: {word}"),
    )
    for step in tester.steps():
        if step.group.name == "declared facts" or (
            step.group.name == "settings" and step.command and step.command.name == "set_fresh_mode"
        ):
            tester.report.results += tester.results(step)
    [result] = [r for r in tester.report.results if r.case == "declared-acknowledgements"]
    right = (word == "all") is acks
    assert result.verdict is (Verdict.PASS if right else Verdict.FAIL), result.reason
