"""The figures, links and pictures of the README are those of the pages and tools that it names."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

import figures
from record_picture import drawn, record
from vectors import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
HERE = re.compile(
    r"https://(?:github|raw\.githubusercontent)\.com/cobotwire/cobotwire/(?:blob/)?main/"
)
SVG = "{http://www.w3.org/2000/svg}"


# What fits on two screens, as GitHub shows it.
MOST_WORDS = 700


def test_readme_fits_on_two_screens() -> None:
    assert len(README.split()) <= MOST_WORDS
    assert len(README.splitlines()) <= 110


def test_comparison_repeats_the_figures_of_the_measured_pages() -> None:
    page = figures.PAGE.read_text(encoding="utf-8")
    assert figures.block(page, "compared") == figures.compared()
    assert figures.block(README, "compared") == figures.compared(in_readme=True)
    assert len(figures.block(README, "compared").splitlines()) == len(["head", "rule"]) + 5


def test_numbers_of_runs_and_calls_are_the_sums_of_the_measured_pages() -> None:
    ends = ("right", "honest error", "-1 or None", "wrong, silently")
    on_lines = figures.ours_and_theirs(figures.LINES, *ends, "crash", "sent too often", "hang")
    with_faults = figures.ours_and_theirs(figures.FAULTS, *ends, "exception", "not ended")
    scenarios = re.findall(
        r"^\| \S+ \|.*\|.*\|.*\|.*\|$", (figures.DOCS / figures.FAULTS).read_text(), re.M
    )
    faults = len(scenarios) - len(["heading", "no fault"])
    assert (on_lines, with_faults, faults) == ((86, 86), (720, 720), 39)
    labels = [row.label for row in figures.COUNTED]
    assert labels[0].startswith("86 runs")
    assert "720 calls, 18 with each of 39 faults and 18 without: right" in labels


def test_links_of_the_readme_lead_to_files_of_the_repository() -> None:
    targets = re.findall(r'(?:\]\(|src="|srcset=")([^)"]+)', README)
    local = [HERE.sub("", target) for target in targets]
    assert len(local) > 20
    assert [path for path in local if not (ROOT / path).exists()] == []
    assert [target for target in targets if not HERE.match(target)] == []


def test_pictures_show_program_arm_and_monitor() -> None:
    for name in ("arm", "arm-still"):
        root = ET.parse(ROOT / "docs" / "pictures" / f"{name}.svg").getroot()
        texts = " ".join(text.text or "" for text in root.iter(f"{SVG}text"))
        assert all(word in texts for word in (">>>", "get_angles", "UsageError", "go_home"))
        assert bool(list(root.iter(f"{SVG}animateTransform"))) == (name == "arm")


def test_recording_follows_the_arm(tmp_path: Path) -> None:
    found = record(["arm.power_on()", "arm.move_angles([30, 0, 0, 0, 0, 0], speed=100)"], port=0)
    assert found.angles[0] == pytest.approx([0] * 6, abs=0.1)
    assert found.angles[-1] == pytest.approx([30, 0, 0, 0, 0, 0], abs=0.1)
    root = ET.fromstring(drawn(found))
    line = next(each for each in root.iter(f"{SVG}polyline") if "a5d0ff" in each.attrib["stroke"])
    [moved] = line
    assert moved.attrib["values"].startswith(line.attrib["points"])
    assert len(moved.attrib["values"].split(";")) == len(moved.attrib["keyTimes"].split(";")) > 3
    shown = " ".join(text.text or "" for text in root.iter(f"{SVG}text")).replace("\xa0", " ")
    assert "j1    29.97" in shown or "j1    30.0" in shown
