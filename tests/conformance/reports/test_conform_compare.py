"""``cobotwire conform compare``, and the report files of a run."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner

from cobotwire.cli.app import app
from cobotwire.conformance import Verdict
from cobotwire.conformance.reports import from_json, to_json


def _run(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, list(words))
    return result.exit_code, result.output


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder with a run's report in every form."""
    folder = tmp_path_factory.mktemp("reports")
    files = [f"--{form}={folder / f'report.{form}'}" for form in ("json", "html", "junit")]
    status, _ = _run("conform", "device", "--simulated", *files)
    assert status == 0
    return folder


def test_run_writes_every_form_of_its_report(written: Path) -> None:
    report = from_json((written / "report.json").read_text())
    assert report.subject == "simulated arm in memory"
    assert report.conforms
    assert any(result.verdict is Verdict.PASS for result in report.results)
    assert report.deadline_seconds["get_angles"] == 0.5
    page = (written / "report.html").read_text()
    assert page.startswith("<!doctype html>")
    assert "It conforms" in page
    suites = ElementTree.parse(written / "report.junit").getroot()
    assert suites.get("name") == "cobotwire conform device"


def test_equal_reports_end_with_0(written: Path) -> None:
    report = str(written / "report.json")
    assert _run("conform", "compare", report, report) == (0, "No verdict differs.\n")


def test_new_failure_ends_with_1_and_is_shown(written: Path, tmp_path: Path) -> None:
    report = from_json((written / "report.json").read_text())
    place = next(i for i, r in enumerate(report.results) if r.verdict is Verdict.PASS)
    old = report.results[place]
    changed = type(old)(old.case, old.command, Verdict.FAIL, "it went wrong")
    report.results[place] = changed
    worse = tmp_path / "worse.json"
    worse.write_text(to_json(report))
    before = str(written / "report.json")
    status, text = _run("conform", "compare", before, str(worse))
    assert status == 1
    assert "it went wrong" in text
    assert "1 worse" in text
    assert _run("conform", "compare", str(worse), before)[0] == 0
    status, text = _run("conform", "compare", "--json", before, str(worse))
    assert status == 1
    assert [change["kind"] for change in json.loads(text)["changes"]] == ["worse"]


@pytest.mark.parametrize("text", [None, "nonsense"])
def test_unreadable_report_ends_with_2(written: Path, tmp_path: Path, text: str | None) -> None:
    path = tmp_path / "other.json"
    if text is not None:
        path.write_text(text)
    status, output = _run("conform", "compare", str(written / "report.json"), str(path))
    assert status == 2
    assert "report" in output
