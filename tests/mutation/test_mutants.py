"""The testers kill a sample of the mutants; `make conform` runs more of them (``MUTANTS``)."""

from __future__ import annotations

import os
from random import Random

import pytest

from cobotwire import editions
from mutation.device import device_mutants
from mutation.device.broken import Fault, Mutant
from mutation.device.cells import STIMULI
from mutation.oracle.conversation import conversations, replies_of
from mutation.oracle.reasons import reason
from mutation.oracle.undefined import UNWIRED
from mutation.running import SUITES, Key, made, run, sampled
from mutation.suite import Suite, missed
from vectors import sampled as sampled_editions

KINDS = {
    *("sign", "scale", "width", "order", "endianness", "range", "value", "echo", "text"),
    *("LEN", "id", "footer", "header", "no reply", "late reply", "double reply", "ignored"),
    *("stored wrong", "wrong part", "wrong ack", "malformed input", "state lost", "stale reply"),
}
# The test cases of one command kill these, so a run takes milliseconds.
QUICK = {"header", "LEN", "no reply"}
FRAMING = {"LEN", "id", "footer", "check", "header", "address"}
# An edition of unknown geometry; one with a check value, events and fields of bytes; one with
# addresses.
FORMATS = {"mypalletizer260", "mercury_a1", "mybuddy"}
# For each suite: the least number of mutants it must have, and how many of each kind are run.
SAMPLES = {
    Key("device", "mycobot280"): (2000, 1),
    Key("client with a script", "mycobot280"): (5000, 3),
    Key("client without a script", "mycobot280"): (5000, 3),
    Key("codec", "mycobot"): (1000, 3),
}


# At most this many mutants of each kind in every suite, or "all"; left out: the samples above.
MUTANTS = os.environ.get("MUTANTS", "")
PROCESSES = 2 if MUTANTS else 1
# The editions and testers to which `make conform` is restricted.
ONLY = os.environ.get("EDITIONS", "").split()
CHOSEN = [key for key in SUITES if not ONLY or {*key} & {*ONLY}] if MUTANTS else [*SAMPLES]


@pytest.mark.parametrize("key", CHOSEN, ids=str)
def test_each_mutant_of_a_suite_is_killed_or_excused(key: Key) -> None:
    least, sample = SAMPLES.get(key, (100, 3))
    suite = made(key)
    assert len(suite.mutants) >= least
    assert key not in SAMPLES or key.tester != "device" or _kinds(suite) == KINDS
    most = (None if MUTANTS == "all" else int(MUTANTS)) if MUTANTS else sample
    outcomes = run(key, sampled(suite, most, seed=7), PROCESSES)
    killed, excused = (sum(bool(each[at]) for each in outcomes) for at in (2, 3))
    print(f"{key}: {killed} killed + {excused} indistinguishable of {len(outcomes)}")
    print(*(f"{each.id}: {each.reason}" for each in outcomes if not each.killed_by), sep="\n")
    assert missed(outcomes) == []


def _kinds(suite: Suite) -> set[str]:
    return {mutant.kind for mutant in suite.mutants.values()}


# tests/conformance tests correct devices and codecs.
@pytest.mark.parametrize(
    "key", [key for key in CHOSEN if MUTANTS or "client" in key.tester], ids=str
)
def test_correct_subject_passes(key: Key) -> None:
    suite = made(key)
    step = 1 if MUTANTS == "all" else max(1, len(suite.right_runs) // 2)
    for name in suite.right_runs[::step]:
        assert suite.failure(name) == ""


OTHERS = {*FORMATS, *sampled_editions()} - {
    key.edition for key in SAMPLES if key.tester == "device"
}


@pytest.mark.parametrize("edition", sorted(OTHERS))
def test_broken_device_of_each_other_edition_is_found(edition: str) -> None:
    suite = made(Key("device", edition))
    kinds = QUICK | (FRAMING if edition in FORMATS else set())
    # Each edition gets other commands.
    seed = Random(edition).randrange(1 << 32)
    chosen = [id for id in sampled(suite, 1, seed) if suite.mutants[id].kind in kinds]
    outcomes = [suite.outcome(id) for id in chosen]
    killed = {outcome.kind for outcome in outcomes if outcome.killed_by}
    assert missed(outcomes) == []
    assert killed >= QUICK
    assert len(killed) > len(outcomes) / 2


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


# An edition with several devices; one with events between replies, also together with late replies.
@pytest.mark.parametrize("edition", ["mycobot", "mycobot280", "mybuddy", "mercury_a1", "pro630"])
def test_broken_arm_without_a_fault_passes_as_correct(edition: str) -> None:
    table = editions.load(edition).TABLE
    for conversation in conversations(table, "", rounds=3):
        found = replies_of(table, Mutant("none", "", Fault), conversation)
        assert found == conversation.received != []


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
