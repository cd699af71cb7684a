"""Implementations that crash, hang, babble, lie or change their mind fail; nothing is raised."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from cobotwire.codec.reference import ReferenceCodec
from cobotwire.conformance.codec import NoAnswer, Program, Run, Trial, derive, read_expectations
from cobotwire.conformance.codec.adapter.ours import OurCodec
from cobotwire.conformance.codec.trials import Json
from cobotwire.conformance.report import Report, Result, Verdict
from cobotwire.editions.mycobot import TABLE
from cobotwire.errors import LinkError, UsageError

HELLO = (
    "import json, sys, time\n"
    "def say(**words): print(json.dumps(words), flush=True)\n"
    "hello = json.loads(input())\n"
    "say(id=hello['id'], protocol=1, edition=hello['edition'], name='odd', can=['decode reply'])\n"
)
ASKED = "asked = json.loads(input())\n"


@pytest.fixture(scope="module")
def trials() -> list[Trial]:
    return [trial for trial in derive(TABLE) if trial.command == "get_angles"]


@pytest.fixture(scope="module")
def decoding(trials: list[Trial]) -> list[Trial]:
    return [trial for trial in trials if trial.needs == "decode reply"]


def _program(source: str, timeout: float = 5.0) -> Program:
    return Program([sys.executable, "-c", HELLO + source], timeout=timeout)


def _failed(report: Report) -> list[Result]:
    return [result for result in report.results if result.verdict is Verdict.FAIL]


@pytest.mark.parametrize(
    ("source", "says"),
    [
        (ASKED + "sys.exit(7)", "ended with code 7"),
        (ASKED + "raise KeyError('joint')", "last words: KeyError: 'joint'"),
        (ASKED + "print('ready.', flush=True); time.sleep(2)", "is no JSON"),
        (ASKED + "say(id=99); time.sleep(2)", "is no answer to question"),
        (ASKED + "print('[]', flush=True); time.sleep(2)", "is no answer to question"),
        (ASKED + "sys.stdout.write('x' * 2000000); sys.stdout.flush(); time.sleep(2)", "a line of"),
    ],
)
def test_a_command_that_does_not_answer_fails_and_is_asked_again(
    decoding: list[Trial], source: str, says: str
) -> None:
    with _program(source) as program:
        report = Run(TABLE, program).ask_all(decoding[:8])
    [failure] = _failed(report)
    assert failure.rule == "answers"
    assert says in failure.reason
    assert failure.reason.startswith("8 of 8 failed"), "each of them, though it was given up"
    assert report.finished
    assert not report.conforms


def test_a_command_that_hangs_fails_after_the_time_it_is_given(decoding: list[Trial]) -> None:
    began = time.monotonic()
    with _program(ASKED + "time.sleep(60)", timeout=0.2) as program:
        report = Run(TABLE, program).ask_all(decoding[:1])
    assert "no answer within 0.2 s" in _failed(report)[0].reason
    assert time.monotonic() - began < 10


def test_a_command_that_is_not_there_cannot_be_run() -> None:
    with Program(["/nonexistent/codec"]) as program, pytest.raises(LinkError, match="No such file"):
        Run(TABLE, program)


def test_a_command_that_ends_at_once_cannot_be_run() -> None:
    with Program([sys.executable, "-c", ""]) as program:
        with pytest.raises(NoAnswer, match="ended with code 0"):
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
        ({"protocol": 2}, "protocol is 2"),
        ({"edition": "mycobot280"}, "edition is 'mycobot280'"),
        ({"can": "everything"}, "can is 'everything'"),
        ({"error": "not today"}, "not today"),
    ],
)
def test_a_greeting_that_does_not_fit_is_told(hello: Json, wrong: str) -> None:
    with pytest.raises(UsageError, match=wrong):
        Run(TABLE, _Changed(lambda said: {**said, **hello}))


def test_what_is_not_offered_is_not_supported_and_fails_nothing(trials: list[Trial]) -> None:
    encoder = _Changed(lambda said: {**said, "can": ["encode reply"]} if "can" in said else said)
    report = Run(TABLE, encoder).ask_all(trials)
    verdicts = {result.rule: result.verdict for result in report.results}
    assert verdicts["encode-bytes"] is Verdict.PASS
    assert verdicts["decode-values"] is verdicts["stream-frames"] is Verdict.NOT_SUPPORTED
    assert verdicts["refusal-reason"] is verdicts["stream-noise"] is Verdict.NOT_SUPPORTED
    assert report.conforms


def test_answers_that_differ_are_unstable(trials: list[Trial]) -> None:
    turns = iter(range(100_000))

    def moody(said: Json) -> Json:
        return {"error": "no"} if "fields" in said and next(turns) % 2 else said

    report = Run(TABLE, _Changed(moody), repeat=2).ask_all(trials)
    unstable = [r.rule for r in report.results if r.verdict is Verdict.UNSTABLE]
    assert unstable == ["decode-values"]
    assert not report.conforms


def test_a_wrong_value_is_told_with_its_field_and_the_two_values(trials: list[Trial]) -> None:
    def tenfold(said: Json) -> Json:
        if "fields" not in said:
            return said
        fields = {name: [v * 10 for v in row] for name, row in said["fields"].items()}
        return {**said, "fields": fields}

    [failure] = _failed(Run(TABLE, _Changed(tenfold)).ask_all(trials))
    assert (failure.rule, failure.command) == ("decode-values", "get_angles")
    assert "angles: expected [" in failure.reason
    assert [exchange.direction for exchange in failure.evidence] == ["sent", "heard"]


def test_an_echo_need_not_be_told_and_the_rest_must() -> None:
    def without(name: str) -> Callable[[Json], Json]:
        return lambda said: (
            {**said, "fields": {k: v for k, v in said["fields"].items() if k != name}}
            if "fields" in said
            else said
        )

    about = [t for t in derive(TABLE) if t.name.startswith("decode-values/get_joint_min_angle/rep")]
    assert about
    echo = next(f.name for f in TABLE.command("get_joint_min_angle").reply[0].fields if f.echo)
    rest = next(f.name for f in TABLE.command("get_joint_min_angle").reply[0].fields if not f.echo)
    assert Run(TABLE, _Changed(without(echo))).ask_all(about).conforms
    assert not Run(TABLE, _Changed(without(rest))).ask_all(about).conforms


def _run_with(text: str, trials: list[Trial], change: Callable[[Json], Json]) -> Report:
    known = read_expectations(text, "known.txt")
    return Run(TABLE, _Changed(change), expected=known).ask_all(trials)


def _refuse(said: Json) -> Json:
    return {"error": "no"} if "fields" in said else said


def test_an_expected_failure_is_excused_with_its_reason(trials: list[Trial]) -> None:
    text = "# known\n\ndecode-values/get_angles/*   it reads no angles\n"
    report = _run_with(text, trials, _refuse)
    [excused] = [r for r in report.results if r.verdict is Verdict.NOT_SUPPORTED]
    assert excused.reason == "expected to fail (known.txt:3): it reads no angles"
    assert report.conforms


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("decode-values/get_angles/* it reads none", "passed, among them decode-values"),
        ("decode-values/get_angels/* it reads none", "no trial is called decode-values/get_angels"),
    ],
)
def test_an_expectation_that_is_not_met_fails(trials: list[Trial], line: str, says: str) -> None:
    [failure] = _failed(_run_with(line, trials, lambda said: said))
    assert failure.rule == "expected-failure"
    assert says in failure.reason


@pytest.mark.parametrize("text", ["decode-values/x", "a b\na c"])
def test_a_file_of_expectations_is_wrong_at_a_line(text: str) -> None:
    with pytest.raises(UsageError, match=r"known.txt:\d"):
        read_expectations(text, "known.txt")


def test_an_interrupted_run_leaves_a_report(trials: list[Trial]) -> None:
    turns = iter(range(100))

    def interrupted(said: Json) -> Json:
        if next(turns) == 30:
            raise KeyboardInterrupt
        return said

    run = Run(TABLE, _Changed(interrupted))
    with pytest.raises(KeyboardInterrupt):
        run.ask_all(trials)
    assert run.report.results
    assert not run.report.finished


def test_what_a_command_complains_of_does_not_stop_it(trials: list[Trial], tmp_path: Path) -> None:
    script = tmp_path / "loud.py"
    script.write_text(
        "import sys\n"
        "from cobotwire.codec.reference import ReferenceCodec\n"
        "from cobotwire.conformance.codec.adapter.loop import serve\n"
        "from cobotwire.conformance.codec.adapter.ours import OurCodec\n"
        "from cobotwire.editions.mycobot import TABLE\n"
        "ours = OurCodec(ReferenceCodec(TABLE))\n"
        "def loud(question):\n"
        "    sys.stderr.write('hm ' * 2000)\n"
        "    return ours.ask(question)\n"
        "serve(loud, sys.stdin, sys.stdout)\n"
    )
    with Program([sys.executable, str(script)]) as program:
        assert Run(TABLE, program).ask_all(trials[:60]).conforms
