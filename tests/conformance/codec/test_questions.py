"""The questions to codecs are complete and uniquely named, and our codecs answer them correctly."""

from __future__ import annotations

import json
import os
from collections import Counter

import pytest

import npm_package
from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.conformance.codec import Program, Run, derive_questions
from cobotwire.conformance.codec.questions.frames import variants_of
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.report import Verdict
from conformance.codec.questions import questions_of
from strategies import TABLES
from targets.typescript.comparison import package
from vectors import ROOT

# `make every-edition` asks the codec in Node all questions: it answers some 2,000 a second.
EVERY = "EVERY_EDITION" in os.environ


@pytest.mark.parametrize("name", ["native", "reference"])
@pytest.mark.parametrize("edition", TABLES)
def test_both_codecs_pass_every_test_case_of_every_edition(
    edition: str, name: codecs.CodecName
) -> None:
    table = TABLES[edition]
    # The reference codec gave the expected answers.
    questions = questions_of(edition)[:: 7 if name == "reference" else 1]
    report = Run(table, OurCodec(codecs.load(table, name))).ask_all(questions)
    assert report.conforms
    assert {result.verdict for result in report.results} == {Verdict.PASS}


@pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing())
@pytest.mark.parametrize("edition", editions.names() if EVERY else TABLES)
def test_codec_in_node_answers_a_sample_of_questions(edition: str) -> None:
    package()
    questions = questions_of(edition)[:: 1 if EVERY else 23]
    with Program(["node", str(ROOT / "tests/typescript/codec.mjs")]) as program:
        report = Run(editions.load(edition).TABLE, program).ask_all(questions)
    assert report.conforms
    assert {result.verdict for result in report.results} == {Verdict.PASS}


@pytest.mark.parametrize("edition", TABLES)
def test_every_variant_is_encoded_decoded_and_framed(edition: str) -> None:
    found = Counter(
        (question.name.split("/")[0], "/".join(question.name.split("/")[1:3]))
        for question in questions_of(edition)
    )
    for variant in variants_of(TABLES[edition]):
        for kind in ("encode-bytes", "decode-values", "decode-rejects", "stream"):
            assert found[kind, variant.label], (kind, variant.label)


def test_questions_are_the_same_every_time_and_have_unique_names() -> None:
    first, again = questions_of("mycobot"), list(derive_questions(TABLES["mycobot"]))
    assert first == again
    assert len({question.name for question in first}) == len(first)


def test_question_survives_json() -> None:
    for question in questions_of("mycobot"):
        assert json.loads(json.dumps([question.ask, question.expect])) == [
            question.ask,
            question.expect,
        ]
        assert " " not in question.name, "a file of expected failures splits at the first space"


def test_expected_events_of_a_stream_account_for_each_byte() -> None:
    for question in questions_of("mycobot280"):
        if question.ask["do"] == "stream" and question.ask["direction"] != "both":
            fed = "".join(chunk or "" for chunk in question.ask["chunks"])
            events = [event for chunk in question.expect["events"] for event in chunk]
            assert "".join(e.get("frame", "") + e.get("noise", "") for e in events) == fed
