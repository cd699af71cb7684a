"""The testers kill a sample of the mutants; `make conform` runs more of them."""

from __future__ import annotations

from random import Random

import pytest

from cobotwire import editions
from cobotwire.editions import mycobot, mycobot280
from cobotwire.protocol.table import Table
from cobotwire.simulator.clock import SteppedClock
from mutation.device import device_mutants
from mutation.device.broken import BrokenArm, Fault, Mutant
from mutation.device.stimulus import STIMULI
from mutation.listing import counted, lines, table
from mutation.oracle.conversation import conversations, replies_of
from mutation.oracle.reasons import reason
from mutation.oracle.undefined import UNWIRED
from mutation.running import Key, Verdicts, made, sampled
from mutation.suite import Outcome, RightRun, missed
from vectors import sampled as sampled_editions

KINDS = {
    *("sign", "scale", "width", "order", "endianness", "range", "value", "echo", "text"),
    *("LEN", "id", "footer", "header", "no reply", "late reply", "double reply", "ignored"),
    *("stored wrong", "wrong part", "wrong ack", "malformed input", "state lost", "stale reply"),
}
# The test cases of one command kill these, so a run takes milliseconds.
QUICK = ("header", "LEN", "no reply")
FRAMING = {"LEN", "id", "footer", "check", "header", "address"}
# Each suite with the fewest mutants that it has, and how many of each kind are run.
SAMPLES = {
    Key("device", "mycobot280"): (2000, 1),
    Key("client with a script", "mycobot280"): (5000, 3),
    Key("client without a script", "mycobot280"): (5000, 3),
    Key("codec", "mycobot"): (1000, 3),
}


@pytest.mark.parametrize("key", SAMPLES, ids=str)
def test_each_sampled_mutant_is_killed_or_excused(key: Key) -> None:
    least, sample = SAMPLES[key]
    suite = made(key)
    assert len(suite.mutants) >= least
    assert key.tester != "device" or {m.kind for m in suite.mutants.values()} == KINDS
    assert missed(map(suite.outcome, sampled(suite, sample, seed=7))) == []


@pytest.mark.parametrize(
    "edition", [e for e in sampled_editions() if Key("device", e) not in SAMPLES]
)
def test_broken_device_of_each_other_edition_is_found(edition: str) -> None:
    suite = made(Key("device", edition))
    # Each edition gets other commands.
    seed = Random(edition).randrange(1 << 32)
    chosen = [id for id in sampled(suite, 1, seed) if suite.mutants[id].kind in QUICK]
    outcomes = [suite.outcome(id) for id in chosen]
    assert len(outcomes) == len(QUICK)
    assert [outcome for outcome in outcomes if not outcome.killed_by] == []


@pytest.mark.parametrize("after", STIMULI)
def test_setting_that_is_lost_after_malformed_bytes_is_named(after: str) -> None:
    outcome = made(Key("device", "mycobot")).outcome(f"state lost: set_speed: after {after}")
    assert "state-kept: " in outcome.killed_by
    assert "get_speed() to stay" in outcome.killed_by


# Numbers of a row that are set one by one; numbers of a selector; joints that are held one by one.
@pytest.mark.parametrize(
    ("mutant", "killer"),
    [
        (
            "order: get_collision_threshold.thresholds: last element first",
            "set_collision_threshold",
        ),
        ("wrong part: set_model_direction.joint: the next part instead", "set_model_direction"),
        ("stored wrong: set_limit_switch.on: as the next legal value", "set_limit_switch"),
        ("wrong part: focus_servo.joint: the next part instead", "focus_servo"),
    ],
)
def test_wrong_part_of_what_a_command_sets_is_named(mutant: str, killer: str) -> None:
    outcome = made(Key("device", "mercury_a1")).outcome(mutant)
    assert outcome.killed_by.startswith(killer)


# An edition of unknown geometry; one with a check value, events and fields of bytes; one with
# addresses.
@pytest.mark.parametrize("edition", ["mypalletizer260", "mercury_a1", "mybuddy"])
def test_wrong_frame_of_another_edition_is_killed_or_excused(edition: str) -> None:
    suite = made(Key("device", edition))
    chosen = [id for id in sampled(suite, 1, seed=7) if suite.mutants[id].kind in FRAMING]
    outcomes = [suite.outcome(id) for id in chosen]
    assert missed(outcomes) == []
    assert counted(outcomes).killed > len(outcomes) / 2


# tests/conformance tests correct devices and codecs.
@pytest.mark.parametrize("tester", ["client with a script", "client without a script"])
def test_correct_client_passes(tester: str) -> None:
    suite = made(Key(tester, "mycobot280"))
    for name in suite.right_runs[:: len(suite.right_runs) // 2]:
        assert suite.failure(name) == ""


# An edition with several devices; one with events between replies, also together with late replies.
@pytest.mark.parametrize("edition", ["mycobot", "mycobot280", "mybuddy", "mercury_a1", "pro630"])
def test_broken_arm_without_a_fault_passes_as_correct(edition: str) -> None:
    assert not _differs(editions.load(edition).TABLE, Mutant("none", "", Fault), rounds=3)


def _differs(table: Table, mutant: Mutant, rounds: int) -> bool:
    return any(
        replies_of(table, mutant, conversation) != conversation.received
        for conversation in conversations(table, mutant.command, rounds)
    )


def test_wrong_footer_differs_in_some_conversation() -> None:
    table = mycobot280.TABLE
    footers = [mutant for mutant in device_mutants(table) if mutant.kind == "footer"]
    for mutant in footers[::20]:
        assert _differs(table, mutant, rounds=24), mutant.id


@pytest.mark.parametrize(
    ("edition", "mutant", "why"),
    [
        ("mycobot", "stored wrong: set_color.red: half of it", "no byte differs in 24"),
        ("mycobot", "LEN: get_angles: one too many in LEN", ""),
        # An output is read back only where a source says so.
        ("mercury_a1", "wrong part: set_digital_output.pin: the next part instead", UNWIRED),
        ("mycobot280", "wrong part: set_digital_output.pin: the next part instead", ""),
    ],
)
def test_oracle_explains_why_a_survivor_cannot_be_distinguished(
    edition: str, mutant: str, why: str
) -> None:
    table = editions.load(edition).TABLE
    [found] = [each for each in device_mutants(table) if each.id == mutant]
    given = reason(table, found)
    assert why in given
    assert bool(given) == bool(why)


def test_conversation_is_the_same_each_time() -> None:
    conversation = next(conversations(mycobot.TABLE, "get_angles"))
    clock = SteppedClock()
    again = conversation.again(BrokenArm(mycobot.TABLE, Fault(), clock), clock)
    assert again == conversation.received != []


KILLED = Outcome("one", "sign", "a test case")
EXCUSED = Outcome("two", "sign", "", "equal on the line")
MISSED = Outcome("three", "scale", "")
CRASHED = Outcome("four", "scale", "", "", "ValueError: no")


def _verdicts(*outcomes: Outcome, failure: str = "") -> Verdicts:
    return Verdicts(Key("device", "any"), list(outcomes), [RightRun("clean 0", failure)])


def test_run_is_sound_if_all_are_killed_or_excused_and_correct_subjects_pass() -> None:
    assert _verdicts(KILLED, EXCUSED).sound
    assert not _verdicts(KILLED, MISSED).sound
    assert not _verdicts(KILLED, CRASHED).sound
    assert not _verdicts(KILLED, EXCUSED, failure="it failed").sound
    assert counted([KILLED, EXCUSED, MISSED, CRASHED]) == (1, 1, 4)


def test_listing_names_each_survivor_with_its_reason() -> None:
    text = list(lines(_verdicts(KILLED, EXCUSED, MISSED, CRASHED, failure="it failed")))
    assert text[-1] == "  REJECTED  clean 0: it failed"
    assert [line.split()[-1] for line in text if "survived" in line] == ["three", "four", "two"]
    for part in ("equal on the line", "the tester missed it", "ValueError: no"):
        assert any(part in line for line in text)


def test_table_counts_what_each_tester_killed_and_what_is_excused() -> None:
    found = [
        _verdicts(KILLED, EXCUSED, MISSED),
        Verdicts(Key("codec", "any"), [KILLED, KILLED], []),
        Verdicts(Key("device", "other"), [KILLED], []),
    ]
    assert [" ".join(row.split()) for row in table(found).splitlines()[1:]] == [
        "any 1 + 1 of 3 2 + 0 of 2",
        "other 1 + 0 of 1",
    ]
