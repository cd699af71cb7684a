"""Reports state the circumstances of a run, without paths of the tester's machine."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import in_process
import vectors
from cobotwire.cli.app import app
from cobotwire.conformance import Cause, Exchange, Report, Result, Verdict, host
from cobotwire.conformance.expected import read_expectations, with_known
from cobotwire.conformance.privacy import anonymous, hashed, without_paths
from cobotwire.conformance.report import Host
from cobotwire.conformance.reports import from_json, to_html, to_json
from cobotwire.conformance.suite import TestCase
from cobotwire.conformance.tally import Tally


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        (f"{Path.cwd()}/known.txt:3: a reason", "known.txt:3: a reason"),
        (f"{Path.home()}/a b/x.py", "~/a b/x.py"),
        ('File "/opt/tools/codec.py", line 3', 'File "codec.py", line 3'),
        ("command /usr/bin/python3 -m x /dev/ttyACM0", "command python3 -m x /dev/ttyACM0"),
        (r"C:\Users\me\codec.exe --stdio", "codec.exe --stdio"),
        ("/dev/ttyUSB0, socket://10.0.0.2:9000", "/dev/ttyUSB0, socket://10.0.0.2:9000"),
        ("docs/codec-protocol.md and 3 km/h", "docs/codec-protocol.md and 3 km/h"),
        (
            "/dev/serial/by-id/usb-A_123-if00",
            f"/dev/serial/by-id/{hashed('usb-A_123-if00')}",
        ),
    ],
)
def test_path_of_the_machine_is_not_shown(text: str, shown: str) -> None:
    assert without_paths(text) == shown
    assert without_paths(shown) == shown


@given(st.text(), st.text(alphabet="ab/\\:. ~'C"))
def test_removing_paths_twice_equals_removing_them_once(text: str, paths: str) -> None:
    for each in (text, paths):
        assert without_paths(without_paths(each)) == without_paths(each)


def test_paths_are_removed_from_the_bytes_of_codecs_but_not_of_devices() -> None:
    data = b"/home/me/x"
    result = Result("a", "b", Verdict.FAIL, "see /home/me/x", (Exchange(0.1, "sent", data),))
    for kind, kept in (("device", data), ("codec", b"x")):
        report = Report(kind, "mycobot", "arm", results=[result])  # type: ignore[arg-type]  # literals
        [cleaned] = anonymous(report).results
        assert (cleaned.reason, cleaned.evidence[0].data) == ("see x", kept)


def test_report_states_tester_serial_number_clocks_and_load(tmp_path: Path) -> None:
    file, page = tmp_path / "report.json", tmp_path / "page.html"
    known = tmp_path / "known.txt"
    known.write_text("reply-fields/get_angles  planted\nno-such/*  planted\n")
    files = ("--json", str(file), "--html", str(page), "--expected", str(known))
    words = ("conform", "device", "--simulated", "--tester", "Lab 7", "--serial", "S123", *files)
    ended = in_process.run(app, "cobotwire", *words, folder=tmp_path)
    assert ended.returncode == 1
    assert "known.txt:1: 1 did not fail, among them reply-fields/get_angles" in ended.stdout
    assert "known.txt:2: nothing that was tested matches no-such/*" in ended.stdout
    text = file.read_text()
    report = from_json(text)
    assert (report.tester, report.serial) == ("Lab 7", hashed("S123"))
    assert "S123" not in text
    assert str(tmp_path) not in text + page.read_text()
    assert report.host.wall_seconds == pytest.approx(report.host.monotonic_seconds, abs=0.1)
    assert report.clauses["query-replied"] == 1
    assert json.loads(text)["digest"] in page.read_text()
    timed = [result for result in report.results if result.case == "query-replied"]
    assert all(result.load == timed[0].load for result in timed)
    assert (timed[0].load > 0) == (host.load() > 0)


def test_load_is_shown_only_with_verdicts_that_depend_on_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("cobotwire.conformance.tally.load", lambda: 1.5)
    tally, timed, other = Tally(), TestCase("a", "", timed=True), TestCase("b", "")
    for case in (timed, other):
        tally.observe(case, "x", "it came late")
    tally.excuse(other, "y", Cause.NOT_TIMED, "the host was late")
    explained = [result.explained for result in tally.results()]
    load = " (host load 1.50 per processor)"
    assert explained == [f"it came late{load}", "it came late", f"the host was late{load}"]


@pytest.mark.parametrize(
    ("wall", "mistake"), [(10.0, False), (10.1, False), (9.8, True), (3610.0, True)]
)
def test_report_names_a_clock_that_was_set_during_the_run(wall: float, mistake: bool) -> None:
    found = Host(10.0, wall)
    assert bool(host.clock_mistake(found)) is mistake
    report = Report("device", "mycobot", "arm", host=found)
    assert ("The clocks of the host disagree" in to_html(report)) is mistake


def test_known_failure_is_excused_and_known_failure_that_was_not_run_is_ignored() -> None:
    def result(case: str, verdict: Verdict, cause: Cause = Cause.NONE) -> Result:
        return Result(case, "get_x", verdict, "", cause=cause)

    text = "a/get_x  why\nb/*  why\nc/get_x  why\n"
    known = read_expectations(text, "known.txt")
    results = [
        result("a", Verdict.FAIL),
        result("b", Verdict.NOT_RUN, Cause.NOT_PERMITTED),
        result("c", Verdict.PASS),
        result("d", Verdict.FAIL),
    ]
    found = with_known(known, results)
    assert found[0].outcome == "inconclusive (not supported)"
    assert found[0].reason == "expected to fail (known.txt:1): why"
    assert found[1:4] == results[1:]
    assert [(each.case, each.source) for each in found[4:]] == [("expected-failure", "known.txt:3")]


def test_reports_are_shown_side_by_side(tmp_path: Path) -> None:
    paths = []
    for name, verdict in (("one", Verdict.PASS), ("two", Verdict.FAIL), ("three", Verdict.NOT_RUN)):
        report = Report("device", "mycobot", name, finished=True, clauses={"reply-once": 5})
        report.results = [Result("reply-once", "get_angles", verdict, "")]
        report.results += [Result("reply-once", "stop", verdict, "")] * (name != "one")
        path = tmp_path / f"{name}.json"
        path.write_text(to_json(report))
        paths.append(str(path))
    words = ("conform", "matrix", *paths)
    ended = in_process.run(app, "cobotwire", *words, folder=vectors.ROOT)
    assert ended.returncode == 1
    lines = [line.replace("│", " ").split() for line in ended.stdout.splitlines()]
    assert ["5", "reply-once", "1", "pass", "2", "fail", "2", "not", "run"] in lines
    assert ["reply-once", "get_angles", "pass", "fail", "not", "run"] in lines
    assert not [line for line in lines if "stop" in line], "only one report has tested it"
    found = json.loads(in_process.run(app, "cobotwire", *words, "--json").stdout)
    assert [head["subject"] for head in found["reports"]] == ["one", "two", "three"]
    assert found["rows"][0]["outcomes"] == ["pass", "fail", "not run"]
    refused = in_process.run(app, "cobotwire", *words[:3])
    assert (refused.returncode, "needed: 2 to 26" in refused.stderr) == (2, True)
