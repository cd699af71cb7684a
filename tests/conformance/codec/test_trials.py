"""What every codec is asked: complete, told apart by name, and answered rightly by both of ours."""

from __future__ import annotations

import json
from collections import Counter
from functools import lru_cache

import pytest

from cobotwire import codec as codecs
from cobotwire.conformance.codec import Run, Trial, derive
from cobotwire.conformance.codec.adapter.ours import OurCodec
from cobotwire.conformance.codec.trials.frames import forms_of
from cobotwire.conformance.report import Verdict
from strategies import TABLES


@lru_cache
def trials_of(edition: str) -> list[Trial]:
    return list(derive(TABLES[edition]))


@pytest.mark.parametrize("name", ["native", "reference"])
@pytest.mark.parametrize("edition", TABLES)
def test_both_codecs_keep_to_every_edition(edition: str, name: codecs.CodecName) -> None:
    table = TABLES[edition]
    report = Run(table, OurCodec(codecs.load(table, name))).ask_all(trials_of(edition))
    assert report.conforms
    assert {result.verdict for result in report.results} == {Verdict.PASS}


@pytest.mark.parametrize("edition", TABLES)
def test_every_form_is_built_read_and_cut(edition: str) -> None:
    found = Counter(
        (trial.name.split("/")[0], "/".join(trial.name.split("/")[1:3]))
        for trial in trials_of(edition)
    )
    for form in forms_of(TABLES[edition]):
        for kind in ("encode-bytes", "decode-values", "decode-refuses", "stream"):
            assert found[kind, form.label], (kind, form.label)


def test_the_trials_are_the_same_every_time_and_no_two_share_a_name() -> None:
    first, again = trials_of("mycobot280"), list(derive(TABLES["mycobot280"]))
    assert first == again
    assert len({trial.name for trial in first}) == len(first)


def test_a_trial_is_nothing_but_json() -> None:
    for trial in trials_of("mycobot"):
        assert json.loads(json.dumps([trial.ask, trial.expect])) == [trial.ask, trial.expect]
        assert " " not in trial.name, "a file of expected failures splits at the first space"


def test_a_stream_accounts_for_each_of_its_bytes() -> None:
    for trial in trials_of("mycobot280"):
        if trial.ask["do"] == "stream" and trial.ask["direction"] != "both":
            fed = "".join(chunk or "" for chunk in trial.ask["chunks"])
            events = [event for chunk in trial.expect["events"] for event in chunk]
            assert "".join(e.get("frame", "") + e.get("noise", "") for e in events) == fed
