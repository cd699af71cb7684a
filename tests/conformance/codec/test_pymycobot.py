"""pymycobot's processor under test: docs/conformance.md describes these results."""

from __future__ import annotations

import sys

import pytest

from cobotwire.conformance.codec import Program, Run
from cobotwire.conformance.report import Report, Verdict
from cobotwire.editions.mycobot280 import TABLE
from conformance.codec.questions import questions_of

COMMANDS = ("send_angle", "get_angles", "get_encoder", "get_coords", "set_color", "get_radians")


@pytest.fixture(scope="module")
def report() -> Report:
    adapter = [sys.executable, "-m", "cobotwire.conformance.codec.adapter", "pymycobot"]
    questions = [q for q in questions_of("mycobot280") if q.command in COMMANDS]
    with Program(adapter) as program:
        return Run(TABLE, program).ask_all(questions)


def _of(report: Report, case: str, command: str) -> tuple[Verdict, str]:
    [found] = [r for r in report.results if (r.case, r.command) == (case, command)]
    return found.verdict, found.reason


def test_every_question_is_answered(report: Report) -> None:
    assert _of(report, "answers", "")[0] is Verdict.PASS


def test_streams_are_not_supported(report: Report) -> None:
    assert _of(report, "stream-frames", "get_angles")[0] is Verdict.INCONCLUSIVE


def test_simple_messages_pass(report: Report) -> None:
    assert _of(report, "decode-values", "get_angles")[0] is Verdict.PASS
    assert _of(report, "decode-values", "get_coords")[0] is Verdict.PASS
    assert _of(report, "encode-bytes", "set_color")[0] is Verdict.PASS


def test_angles_are_truncated_instead_of_rounded(report: Report) -> None:
    verdict, reason = _of(report, "encode-bytes", "send_angle")
    assert verdict is Verdict.FAIL
    assert "expected FEFE06210100FF1BFA, got FEFE06210100FE1BFA" in reason


def test_minus_one_is_both_a_value_and_a_failure(report: Report) -> None:
    verdict, reason = _of(report, "decode-values", "get_encoder")
    assert (verdict, "encoder=-1" in reason) == (Verdict.FAIL, True)


def test_illegal_frames_are_accepted(report: Report) -> None:
    assert _of(report, "decode-rejects", "get_angles")[0] is Verdict.FAIL
