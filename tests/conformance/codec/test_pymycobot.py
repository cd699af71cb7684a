"""pymycobot's processor under test: docs/conformance.md describes these results."""

from __future__ import annotations

import sys

import pytest

from cobotwire.conformance.codec import Program, Run
from cobotwire.conformance.report import Report, Verdict
from cobotwire.editions.mycobot280 import TABLE
from conformance.codec.questions import questions_of

COMMANDS = ("send_angle", "get_angles", "get_encoder", "get_coords", "set_color")


@pytest.fixture(scope="module")
def report() -> Report:
    adapter = [sys.executable, "-m", "cobotwire.conformance.codec.adapter", "pymycobot"]
    questions = [q for q in questions_of("mycobot280") if q.command in COMMANDS]
    with Program(adapter) as program:
        return Run(TABLE, program).ask_all(questions)


@pytest.mark.parametrize(
    ("case", "command", "verdict", "reason"),
    [
        ("answers", "", Verdict.PASS, ""),
        ("stream-frames", "get_angles", Verdict.INCONCLUSIVE, ""),
        ("decode-values", "get_angles", Verdict.PASS, ""),
        ("decode-values", "get_coords", Verdict.PASS, ""),
        ("encode-bytes", "set_color", Verdict.PASS, ""),
        # It truncates, accepts illegal frames, and reports a failure as -1, which is also a value.
        ("encode-bytes", "send_angle", Verdict.FAIL, "FEFE06210100FF1BFA, got FEFE06210100FE1BFA"),
        ("decode-values", "get_encoder", Verdict.FAIL, "encoder=-1"),
        ("decode-rejects", "get_angles", Verdict.FAIL, ""),
    ],
)
def test_result_is_the_one_that_the_page_describes(
    report: Report, case: str, command: str, verdict: Verdict, reason: str
) -> None:
    [found] = [r for r in report.results if (r.case, r.command) == (case, command)]
    assert found.verdict is verdict
    assert reason in found.reason
