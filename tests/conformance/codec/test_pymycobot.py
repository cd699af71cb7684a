"""pymycobot's processor before the runner: what docs/conformance.md tells of it."""

from __future__ import annotations

import sys

import pytest

from cobotwire.conformance.codec import Program, Run, derive
from cobotwire.conformance.report import Report, Verdict
from cobotwire.editions.mycobot280 import TABLE

COMMANDS = ("send_angle", "get_angles", "get_encoder", "get_coords", "set_color", "get_radians")


@pytest.fixture(scope="module")
def report() -> Report:
    adapter = [sys.executable, "-m", "cobotwire.conformance.codec.adapter", "pymycobot"]
    trials = [trial for trial in derive(TABLE) if trial.command in COMMANDS]
    with Program(adapter) as program:
        return Run(TABLE, program).ask_all(trials)


def _of(report: Report, rule: str, command: str) -> tuple[Verdict, str]:
    [found] = [r for r in report.results if (r.rule, r.command) == (rule, command)]
    return found.verdict, found.reason


def test_it_answers_every_question(report: Report) -> None:
    assert _of(report, "answers", "")[0] is Verdict.PASS


def test_it_cuts_no_streams(report: Report) -> None:
    assert _of(report, "stream-frames", "get_angles")[0] is Verdict.NOT_SUPPORTED


def test_it_reads_and_writes_what_is_simple(report: Report) -> None:
    assert _of(report, "decode-values", "get_angles")[0] is Verdict.PASS
    assert _of(report, "decode-values", "get_coords")[0] is Verdict.PASS
    assert _of(report, "encode-bytes", "set_color")[0] is Verdict.PASS


def test_it_cuts_angles_off_below_the_step(report: Report) -> None:
    verdict, reason = _of(report, "encode-bytes", "send_angle")
    assert verdict is Verdict.FAIL
    assert "expected FEFE06210100FF1BFA, got FEFE06210100FE1BFA" in reason


def test_minus_one_is_both_a_number_and_a_failure(report: Report) -> None:
    verdict, reason = _of(report, "decode-values", "get_encoder")
    assert (verdict, "encoder=-1" in reason) == (Verdict.FAIL, True)


def test_it_takes_frames_that_are_none(report: Report) -> None:
    assert _of(report, "decode-refuses", "get_angles")[0] is Verdict.FAIL
