"""Whole sessions of real clients over a pty and TCP, as bench/client_findings.py plays them."""

from __future__ import annotations

import pytest

from client_findings import LINES, judged
from cobotwire.conformance.report import Verdict

OURS = ["cobotwire", "cobotwire tcp", "cobotwire asyncio", "cobotwire asyncio tcp"]


@pytest.mark.parametrize("client", OURS)
@pytest.mark.parametrize("line", ["good", "no-acks"])
def test_our_clients_pass(client: str, line: str) -> None:
    report, failures = judged(client, LINES[line])
    assert [r for r in report.results if r.verdict is Verdict.FAIL] == []
    assert (report.conforms, failures) == (True, [])


@pytest.mark.parametrize("line", ["lost", "late", "merged", "noise", "split"])
def test_our_client_passes_on_bad_lines(line: str) -> None:
    report, failures = judged("cobotwire", LINES[line])
    assert [r for r in report.results if r.verdict is Verdict.FAIL] == []
    assert (report.conforms, failures) == (True, [])


@pytest.mark.filterwarnings("ignore:.*getdefaultlocale:DeprecationWarning")
def test_pymycobot_on_a_good_line_rounds_to_the_wrong_step_and_no_more() -> None:
    report, failures = judged("pymycobot", LINES["good"])
    found = {(r.rule, r.command) for r in report.results if r.verdict is Verdict.FAIL}
    assert found == {("sent-rounded", "send_radians"), ("sent-rounded", "send_coord")}
    assert failures == []
