"""Implementations that crash, hang, print garbage or answer wrongly fail without an exception."""

from __future__ import annotations

import itertools
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec import (
    NoAnswer,
    Program,
    Question,
    Run,
    read_expectations,
)
from cobotwire.conformance.codec.questions.our_codec import OurCodec
from cobotwire.conformance.codec.questions.question import Json
from cobotwire.conformance.report import Cause
from cobotwire.conformance.reports import from_json, to_html, to_json, to_junit
from cobotwire.editions.mycobot import TABLE
from cobotwire.protocol.errors import LinkError, UsageError
from conformance.codec.questions import questions_of

HELLO = (
    "import json, sys, time\n"
    "def say(**words): print(json.dumps(words), flush=True)\n"
    "hello = json.loads(input())\n"
    "say(id=hello['id'], protocol=1, edition=hello['edition'], name='odd', can=['decode reply'])\n"
)
ASKED = "asked = json.loads(input())\n"


@pytest.fixture(scope="module")
def questions() -> list[Question]:
    return [q for q in questions_of("mycobot") if q.command == "get_angles"]


@pytest.fixture(scope="module")
def decoding(questions: list[Question]) -> list[Question]:
    return [q for q in questions if q.needs == "decode reply"]


def _program(source: str, timeout: float = 5.0) -> Program:
    return Program([sys.executable, "-c", HELLO + source], timeout=timeout)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (ASKED + "sys.exit(7)", "ended with code 7"),
        (ASKED + "raise KeyError('joint')", "last diagnostics: KeyError: 'joint'"),
        (ASKED + "print('ready.', flush=True); time.sleep(2)", "is not JSON"),
        (ASKED + "say(id=99); time.sleep(2)", "is not an answer to question"),
        (ASKED + "print('[]', flush=True); time.sleep(2)", "is not an answer to question"),
        (ASKED + "sys.stdout.write('x' * 2000000); sys.stdout.flush(); time.sleep(2)", "a line of"),
    ],
)
def test_implementation_without_answers_fails_and_is_restarted_at_most_five_times(
    decoding: list[Question], source: str, message: str
) -> None:
    with _program(source) as program:
        report = Run(TABLE, program).ask_all(decoding[:8])
    [failure] = report.failures
    assert failure.case == "answers"
    assert message in failure.reason
    assert failure.reason.endswith("(5 of 5 failed)")
    assert not report.finished
    assert report.stopped == "the codec had ended or hung 5 times"
    assert any(result.cause is Cause.RUN_ENDED for result in report.results)


def test_command_that_hangs_fails_after_its_timeout(decoding: list[Question]) -> None:
    began = time.monotonic()
    with _program(ASKED + "time.sleep(60)", timeout=0.2) as program:
        report = Run(TABLE, program).ask_all(decoding[:1])
    assert "no answer within 0.2 s" in report.failures[0].reason
    assert time.monotonic() - began < 10


def test_missing_command_raises_link_error() -> None:
    with Program(["/nonexistent/codec"]) as program, pytest.raises(LinkError, match="No such file"):
        Run(TABLE, program)


def test_command_that_ends_at_once_raises_no_answer() -> None:
    with Program([sys.executable, "-c", ""]) as program:
        with pytest.raises(
            NoAnswer, match=r"^ended: it did not answer question 1; it ended with code 0$"
        ):
            Run(TABLE, program)


class _Changed(OurCodec):
    def __init__(self, change: Callable[[Json], Json]) -> None:
        super().__init__(ReferenceCodec(TABLE))
        self._change = change

    def ask(self, question: Json) -> Json:
        return self._change(super().ask(question))


@pytest.mark.parametrize(
    ("hello", "wrong"),
    [
        ({"protocol": 2}, "the implementation speaks protocol 2, not 1"),
        ({"edition": "mycobot280"}, "the implementation has edition 'mycobot280', not mycobot"),
        ({"can": "everything"}, "the implementation lists 'everything' under can, not words"),
        ({"error": "not today"}, "not today"),
    ],
)
def test_greeting_that_does_not_fit_is_rejected(hello: Json, wrong: str) -> None:
    with pytest.raises(UsageError, match=wrong):
        Run(TABLE, _Changed(lambda answer: {**answer, **hello}))


def test_ability_that_the_greeting_lacks_is_not_supported_and_does_not_fail(
    questions: list[Question],
) -> None:
    encoder = _Changed(
        lambda answer: {**answer, "can": ["encode reply"]} if "can" in answer else answer
    )
    report = Run(TABLE, encoder).ask_all(questions)
    causes = {result.case: result.cause for result in report.results}
    assert causes["encode-bytes"] is Cause.NONE
    assert causes["decode-values"] is causes["stream-frames"] is Cause.NOT_SUPPORTED
    assert causes["rejection-reason"] is causes["stream-noise"] is Cause.NOT_SUPPORTED
    assert report.conforms


def test_answers_that_differ_are_unstable(questions: list[Question]) -> None:
    turns = iter(range(100_000))

    def moody(answer: Json) -> Json:
        return {"error": "no"} if "fields" in answer and next(turns) % 2 else answer

    report = Run(TABLE, _Changed(moody), repeat=2).ask_all(questions)
    unstable = [r.case for r in report.results if r.cause is Cause.UNSTABLE]
    assert unstable == ["decode-values"]
    assert not report.conforms


def test_wrong_value_fails_with_its_field_and_both_values(questions: list[Question]) -> None:
    def tenfold(answer: Json) -> Json:
        if "fields" not in answer:
            return answer
        fields = {name: [v * 10 for v in row] for name, row in answer["fields"].items()}
        return {**answer, "fields": fields}

    [failure] = Run(TABLE, _Changed(tenfold)).ask_all(questions).failures
    assert (failure.case, failure.command) == ("decode-values", "get_angles")
    assert "angles: expected [" in failure.reason
    assert [exchange.direction for exchange in failure.evidence] == ["sent", "received"]


def test_frame_that_is_reported_a_chunk_late_fails_the_test_case_of_chunks(
    questions: list[Question],
) -> None:
    def late(answer: Json) -> Json:
        if len(answer.get("events", [])) < 2:
            return answer
        *first, before, last = answer["events"]
        return {"events": [[], *first, before + last]}

    report = Run(TABLE, _Changed(late)).ask_all(questions)
    [failure] = report.failures
    assert failure.case == "stream-chunks"
    assert "chunk 0: expected " in failure.reason
    assert ", got nothing more" in failure.reason


def test_answer_may_omit_an_echo_but_no_other_field() -> None:
    def without(name: str) -> Callable[[Json], Json]:
        return lambda answer: (
            {**answer, "fields": {k: v for k, v in answer["fields"].items() if k != name}}
            if "fields" in answer
            else answer
        )

    about = [
        t
        for t in questions_of("mycobot")
        if t.name.startswith("decode-values/get_joint_min_angle/rep")
    ]
    assert about
    echo = next(f.name for f in TABLE.command("get_joint_min_angle").reply[0].fields if f.echo)
    rest = next(f.name for f in TABLE.command("get_joint_min_angle").reply[0].fields if not f.echo)
    assert Run(TABLE, _Changed(without(echo))).ask_all(about).conforms
    assert not Run(TABLE, _Changed(without(rest))).ask_all(about).conforms


@pytest.mark.parametrize(
    ("line", "works", "reason"),
    [
        ("get_angles/*  it reads none", False, "expected to fail (known.txt:1): it reads none"),
        ("get_angles/* it reads none", True, "did not fail, among them decode-values"),
        ("get_angels/* why", True, "nothing that was tested matches decode-values"),
    ],
)
def test_expected_failure_is_excused_and_one_that_is_not_met_fails(
    questions: list[Question], line: str, works: bool, reason: str
) -> None:
    def reject(answer: Json) -> Json:
        return {"error": "no"} if "fields" in answer and not works else answer

    known = read_expectations(f"decode-values/{line}\n", "known.txt")
    report = Run(TABLE, _Changed(reject), expected=known).ask_all(questions)
    [found] = [r for r in report.results if r.case == "expected-failure" or "known.txt" in r.reason]
    assert report.conforms is not works
    assert reason in found.reason


@pytest.mark.parametrize("text", ["decode-values/x", "a b\na c"])
def test_error_in_a_file_of_expectations_names_the_line(text: str) -> None:
    with pytest.raises(UsageError, match=r"known.txt:\d"):
        read_expectations(text, "known.txt")


def test_interrupted_run_leaves_an_unfinished_report(questions: list[Question]) -> None:
    turns = iter(range(100))

    def interrupted(answer: Json) -> Json:
        if next(turns) == 30:
            raise KeyboardInterrupt
        return answer

    run = Run(TABLE, _Changed(interrupted))
    with pytest.raises(KeyboardInterrupt):
        run.ask_all(questions)
    assert run.report.results
    assert not run.report.finished


def test_full_standard_error_does_not_stop_a_command(
    questions: list[Question], tmp_path: Path
) -> None:
    script = tmp_path / "loud.py"
    script.write_text(
        "import json, sys\n"
        "from cobotwire.codec.reference import ReferenceCodec\n"
        "from cobotwire.conformance.codec.questions.our_codec import OurCodec\n"
        "from cobotwire.editions.mycobot import TABLE\n"
        "ours = OurCodec(ReferenceCodec(TABLE))\n"
        "for line in sys.stdin:\n"
        "    question = json.loads(line)\n"
        "    sys.stderr.write('hm ' * 2000)\n"
        "    print(json.dumps({'id': question['id'], **ours.ask(question)}), flush=True)\n"
    )
    with Program([sys.executable, str(script)]) as program:
        assert Run(TABLE, program).ask_all(questions[:60]).conforms


JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**400), 10**400)
    | st.floats()
    | st.text(st.characters(exclude_categories=()), max_size=8)
    | st.sampled_from(["\ud800", "get_angles", "FE FE", "unsupported", "\x1b[2J"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["bytes", "fields", "command", "error", "offset", "angles"])
            | st.sampled_from(["events", "frame", "noise", "reason", "unsupported", "\udfff"]),
            inner,
        )
    ),
    max_leaves=12,
)


ONE_OF_EACH_CASE = list({q.case: q for q in questions_of("mycobot")}.values())


@given(st.lists(JSON, min_size=1, max_size=6))
def test_answer_of_any_values_gets_a_verdict(answers: list[Any]) -> None:
    rest = itertools.cycle(answers)

    def babble(right: Json) -> Json:
        wrong = next(rest)
        if "can" in right:
            return right
        return wrong if isinstance(wrong, dict) else dict.fromkeys(right, wrong)

    report = Run(TABLE, _Changed(babble)).ask_all(ONE_OF_EACH_CASE)
    assert report.finished
    # Each report can be written, too.
    from_json(to_json(report))
    to_html(report).encode()
    ElementTree.fromstring(to_junit(report).encode())


@pytest.mark.parametrize("depth", [17, 990, 100_000])
@pytest.mark.parametrize("brackets", ["[]", "{}"], ids=["lists", "objects"])
def test_deeply_nested_answer_is_invalid_output(
    decoding: list[Question], depth: int, brackets: str
) -> None:
    opening = "[" if brackets == "[]" else '{"a":'
    nested = f"{opening!r} * {depth} + '1' + {brackets[1]!r} * {depth}"
    answer = f"print('{{\"id\": %d, \"fields\": %s}}' % (asked['id'], {nested}), flush=True)\n"
    with _program(ASKED + answer + "time.sleep(2)") as program:
        report = Run(TABLE, program).ask_all(decoding[:1])
    [failure] = [result for result in report.failures if "nested" in result.reason]
    assert "is nested too deeply" in failure.reason


def test_command_that_closes_its_output_and_runs_on_is_silent_and_has_not_crashed() -> None:
    script = "import os, time; os.close(1); time.sleep(60)"
    with Program([sys.executable, "-c", script], timeout=5) as program:
        with pytest.raises(NoAnswer, match=r"^silent: it closed its output but is still running$"):
            Run(TABLE, program)
