"""Mutants of the device: what they are, that the tester finds them, and that a run says so."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from cobotwire.editions import mycobot, mycobot280
from cobotwire.sim.clock import SteppedClock
from cobotwire.table import Table
from mutation.device import device_mutants
from mutation.device.broken import BrokenArm, Fault
from mutation.device.suite import DeviceSuite
from mutation.mutant import Mutant
from mutation.oracle.compare import conversations, first_difference
from mutation.oracle.reasons import reason
from mutation.running import Verdicts, sampled
from mutation.suite import Case, Outcome, Trial, total
from mutation.words import lines, page

TABLES = (mycobot.TABLE, mycobot280.TABLE)
BOTH = pytest.mark.parametrize("table", TABLES, ids=lambda table: table.edition)
# The kinds of fault that the issue names, and some more.
KINDS = {
    *("sign", "scale", "width", "order", "endianness", "range", "value", "echo", "text"),
    *("LEN", "id", "footer", "header", "no reply", "late reply", "double reply"),
    *("ignored", "stored wrong", "wrong part", "ack where none is due", "malformed input"),
}


@pytest.fixture(scope="module", params=TABLES, ids=lambda table: table.edition)
def suite(request: pytest.FixtureRequest) -> DeviceSuite:
    return DeviceSuite(request.param)


@BOTH
def test_every_kind_of_fault_is_there_and_no_mutant_twice(table: Table) -> None:
    mutants = device_mutants(table)
    assert {mutant.kind for mutant in mutants} == KINDS
    assert len({mutant.id for mutant in mutants}) == len(mutants) >= 300


@BOTH
def test_without_a_fault_the_wrapper_is_the_right_device(table: Table) -> None:
    right = Mutant("none", "", "", "", lambda clock: BrokenArm(table, Fault(), clock))
    assert first_difference(table, right, rounds=6) is None


@BOTH
def test_each_reply_that_is_framed_wrong_differs_in_some_conversation(table: Table) -> None:
    framed = [mutant for mutant in device_mutants(table) if mutant.kind == "footer"]
    for mutant in framed[::9]:
        assert first_difference(table, mutant) is not None, mutant.id


def test_the_oracle_says_why_nobody_could_tell() -> None:
    table = mycobot.TABLE
    mutants = {mutant.id: mutant for mutant in device_mutants(table)}
    colour = mutants["stored wrong: set_color.red: half of it"]
    assert "no reply shows what it does" in reason(table, colour)
    assert reason(table, mutants["LEN: get_angles: one too many in LEN"]) == ""


def test_a_conversation_is_the_same_each_time() -> None:
    one, other = (next(iter(conversations(mycobot.TABLE, "get_angles"))) for _ in range(2))
    assert one.steps == other.steps
    assert one.heard == other.heard
    clock = SteppedClock()
    assert one.again(BrokenArm(mycobot.TABLE, Fault(), clock), clock) == one.heard


def test_the_tester_finds_a_sample_of_each_kind(suite: DeviceSuite) -> None:
    for case in sampled(suite.cases(), 2, seed=7):
        outcome = suite.judge(case)
        assert outcome.killed_by or outcome.reason, (case.id, outcome.crash)


def test_the_right_device_passes_on_a_clean_line_and_a_noisy_one(suite: DeviceSuite) -> None:
    trials = suite.trials()
    assert [trial.split()[0] for trial in trials] == ["clean"] * 20 + ["noisy"] * 20
    for name in (trials[0], trials[-1]):
        trial = suite.accept(name)
        assert trial.passed, trial.text


def _verdicts(outcomes: Sequence[Outcome], *, accepted: bool = True) -> Verdicts:
    return Verdicts("a tester", list(outcomes), [Trial("clean 0", accepted, "it said no")])


FOUND = Outcome(Case("one", "sign"), "a rule")
EXCUSED = Outcome(Case("two", "sign"), "", "nobody could tell")
MISSED = Outcome(Case("three", "scale"), "")
BROKE = Outcome(Case("four", "scale"), "", "", "ValueError: no")


def test_a_run_is_sound_if_all_are_found_or_excused_and_the_right_one_passes() -> None:
    assert _verdicts([FOUND, EXCUSED]).sound
    assert not _verdicts([FOUND, MISSED]).sound
    assert not _verdicts([FOUND, BROKE]).sound
    assert not _verdicts([FOUND, EXCUSED], accepted=False).sound
    assert total([FOUND, EXCUSED, MISSED, BROKE]) == (1, 1, 4)


def test_words_name_each_survivor_with_its_reason(tmp_path: Path) -> None:
    verdicts = _verdicts([FOUND, EXCUSED, MISSED, BROKE], accepted=False)
    for text in ("\n".join(lines(verdicts)), page([verdicts], 1.0)):
        for told in ("two", "nobody could tell", "three", "a fault of the tester", "ValueError"):
            assert told in text
        assert "a rule" not in text
    assert "REFUSED  clean 0: it said no" in "\n".join(lines(verdicts))
