"""The device tester kills a sample of the broken devices; the listing names the survivors."""

from __future__ import annotations

import re
from collections.abc import Sequence

import pytest

from cobotwire import editions
from cobotwire.editions import mycobot, mycobot280
from cobotwire.protocol.table import Table
from cobotwire.simulator.clock import SteppedClock
from mutation.device import device_mutants
from mutation.device.broken import BrokenArm, Fault
from mutation.device.suite import DeviceSuite
from mutation.listing import lines, table
from mutation.mutant import Mutant
from mutation.oracle.compare import conversations, first_difference
from mutation.oracle.reasons import reason
from mutation.oracle.undefined import UNWIRED
from mutation.running import Verdicts, sampled
from mutation.suite import Case, Outcome, RightRun, total

TABLES = (mycobot.TABLE, mycobot280.TABLE)
BOTH = pytest.mark.parametrize("table", TABLES, ids=lambda table: table.edition)
KINDS = {
    *("sign", "scale", "width", "order", "endianness", "range", "value", "echo", "text"),
    *("LEN", "id", "footer", "header", "no reply", "late reply", "double reply"),
    *(
        "ignored",
        "stored wrong",
        "wrong part",
        "wrong ack",
        "malformed input",
        "state lost",
        "stale reply",
    ),
}

FRAMING = {"LEN", "id", "footer", "check", "header", "address"}


@pytest.fixture(scope="module", params=TABLES, ids=lambda table: table.edition)
def suite(request: pytest.FixtureRequest) -> DeviceSuite:
    return DeviceSuite(request.param)


@BOTH
def test_mutants_have_every_kind_of_fault_and_unique_ids(table: Table) -> None:
    mutants = device_mutants(table)
    assert {mutant.kind for mutant in mutants} == KINDS
    assert len({mutant.id for mutant in mutants}) == len(mutants) >= 300


# Of several devices; with events that are sent between replies, alone and with late replies.
@pytest.mark.parametrize("edition", ["mycobot", "mycobot280", "mybuddy", "mercury_a1", "pro630"])
def test_broken_arm_without_a_fault_passes_as_correct(edition: str) -> None:
    table = editions.load(edition).TABLE
    right = Mutant("none", "", "", "", lambda clock: BrokenArm(table, Fault(), clock))
    assert first_difference(table, right, rounds=3) is None


@BOTH
def test_wrong_footer_differs_in_some_conversation(table: Table) -> None:
    framed = [mutant for mutant in device_mutants(table) if mutant.kind == "footer"]
    for mutant in framed[::9]:
        assert first_difference(table, mutant) is not None, mutant.id


def test_oracle_explains_why_a_survivor_cannot_be_distinguished() -> None:
    table = mycobot.TABLE
    mutants = {mutant.id: mutant for mutant in device_mutants(table)}
    colour = mutants["stored wrong: set_color.red: half of it"]
    assert "no reply shows the effect of the fault" in reason(table, colour)
    assert reason(table, mutants["LEN: get_angles: one too many in LEN"]) == ""


@pytest.mark.parametrize(("edition", "known"), [("mercury_a1", True), ("mycobot280", False)])
def test_output_is_read_back_only_where_a_source_says_so(edition: str, known: bool) -> None:
    table = editions.load(edition).TABLE
    mutants = {mutant.id: mutant for mutant in device_mutants(table)}
    other_pin = mutants["wrong part: set_digital_output.pin: the next part instead"]
    assert reason(table, other_pin) == (UNWIRED if known else "")


def test_conversation_is_the_same_each_time() -> None:
    one, other = (next(iter(conversations(mycobot.TABLE, "get_angles"))) for _ in range(2))
    assert one.steps == other.steps
    assert one.received == other.received
    clock = SteppedClock()
    assert one.again(BrokenArm(mycobot.TABLE, Fault(), clock), clock) == one.received


def test_each_sampled_mutant_is_killed_or_excused(suite: DeviceSuite) -> None:
    for case in sampled(suite.cases(), 2, seed=7):
        outcome = suite.judge(case)
        assert outcome.killed_by or outcome.reason, (case.id, outcome.crash)


# Of unknown geometry; with a check value, events and fields of bytes; with addresses.
@pytest.mark.parametrize("edition", ["mypalletizer260", "mercury_a1", "mybuddy"])
def test_wrong_frame_of_another_edition_is_killed_or_excused(edition: str) -> None:
    suite = DeviceSuite(editions.load(edition).TABLE)
    cases = [case for case in sampled(suite.cases(), 1, seed=7) if case.kind in FRAMING]
    outcomes = [suite.judge(case) for case in cases]
    assert [o.case.id for o in outcomes if not (o.killed_by or o.reason)] == []
    assert sum(bool(o.killed_by) for o in outcomes) > len(outcomes) / 2


def test_correct_device_passes_on_a_clean_line_and_a_noisy_one(suite: DeviceSuite) -> None:
    names = suite.right_runs()
    assert [name.split()[0] for name in names] == ["clean"] * 20 + ["noisy"] * 20
    for name in (names[0], names[-1]):
        run = suite.accept(name)
        assert run.passed, run.text


def _verdicts(outcomes: Sequence[Outcome], *, accepted: bool = True) -> Verdicts:
    return Verdicts("a tester", list(outcomes), [RightRun("clean 0", accepted, "it failed")])


KILLED = Outcome(Case("one", "sign"), "a test case")
EXCUSED = Outcome(Case("two", "sign"), "", "equal on the line")
MISSED = Outcome(Case("three", "scale"), "")
CRASHED = Outcome(Case("four", "scale"), "", "", "ValueError: no")


def test_run_is_sound_if_all_are_killed_or_excused_and_correct_subjects_pass() -> None:
    assert _verdicts([KILLED, EXCUSED]).sound
    assert not _verdicts([KILLED, MISSED]).sound
    assert not _verdicts([KILLED, CRASHED]).sound
    assert not _verdicts([KILLED, EXCUSED], accepted=False).sound
    assert total([KILLED, EXCUSED, MISSED, CRASHED]) == (1, 1, 4)


def test_listing_names_each_survivor_with_its_reason() -> None:
    verdicts = _verdicts([KILLED, EXCUSED, MISSED, CRASHED], accepted=False)
    text = "\n".join(lines(verdicts))
    for part in ("two", "equal on the line", "three", "the tester missed it", "ValueError"):
        assert part in text
    assert "a test case" not in text
    assert "REJECTED  clean 0: it failed" in text


def test_table_counts_what_each_tester_killed_and_what_is_excused() -> None:
    found = [
        _verdicts([KILLED, EXCUSED, MISSED])._replace(name="device, mycobot"),
        _verdicts([KILLED, KILLED])._replace(name="codec, mycobot"),
        _verdicts([KILLED])._replace(name="device, pro400"),
    ]
    _, *rows = table(found).splitlines()
    assert [re.split(r"\s{2,}", row) for row in rows] == [
        ["mycobot", "1 + 1 of 3", "2 + 0 of 2"],
        ["pro400", "1 + 0 of 1", ""],
    ]
