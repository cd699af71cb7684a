"""A run without motion names joints at zero, where a wrong scale or order does not show."""

from __future__ import annotations

import pytest

from cobotwire.conformance.device import Tester
from cobotwire.conformance.reports import from_json, to_html, to_json, to_junit
from cobotwire.editions.mycobot import TABLE
from cobotwire.simulator.clock import SteppedClock
from conformance.device.testing import on_peer, permissions
from defects.arm.planted import arm_with
from defects.devices import OurTester

SAYS = "Not tested away from zero: joint {}."


def prepared_at(ticks: list[int], defect: str, *allow: str) -> Tester:
    clock = SteppedClock()
    arm = arm_with(clock, defect)
    arm.travel.put(ticks)
    return on_peer(arm, clock, TABLE, OurTester, permissions=permissions(*allow))


@pytest.mark.parametrize("defect", ["", "two-joints-swapped"])
def test_report_of_an_arm_at_zero_names_the_permission_motion(defect: str) -> None:
    report = prepared_at([0] * 6, defect, "setting").run()
    assert report.untested.startswith(SAYS.format("1, 2, 3, 4, 5, 6"))
    assert "--allow motion" in report.untested
    for text in (to_html(report), to_junit(report), from_json(to_json(report)).untested):
        assert SAYS.format("1, 2, 3, 4, 5, 6") in text


def test_only_joints_at_zero_are_named() -> None:
    assert SAYS.format("2, 5") in prepared_at([200, 10, 300, -90, 0, 100], "").run().untested


@pytest.mark.parametrize("defect", ["tenths-of-degrees", "two-joints-swapped", "joints-in-reverse"])
def test_run_with_motion_finds_mistakes_that_do_not_show_at_zero(defect: str) -> None:
    report = prepared_at([0] * 6, defect, "motion", "power").run()
    assert report.untested == ""
    assert report.failures
