"""The figures, links and pictures of the README are those of the pages and tools that it names."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from record_picture import drawn, record
from vectors import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
HERE = re.compile(
    r"https://(?:github|raw\.githubusercontent)\.com/cobotwire/cobotwire/(?:blob/)?main/"
)
SVG = "{http://www.w3.org/2000/svg}"


def cells(text: str, label: str) -> list[str]:
    """Return the cells after the label of the only row of a text that starts with it."""
    [row] = re.findall(rf"^\| {re.escape(label)} \|(.*)\|$", text, re.MULTILINE)
    return [cell.strip() for cell in row.split("|")]


def our_and_their(page: str, *labels: str) -> tuple[int, int]:
    """Return the sums of rows of a page: of our client with its defaults, and of the library."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    # The first row of each outcome is that of the summary.
    rows = [re.search(rf"^\| {re.escape(each)} \|(.*)\|$", text, re.MULTILINE) for each in labels]
    counts = [[int(cell) for cell in row[1].split("|")] for row in rows if row]
    assert len(counts) == len(labels), page
    return sum(row[0] for row in counts), sum(row[-1] for row in counts)


LINES = "bad-lines.md"
FAULTS = "fault-scenarios.md"
ROWS = [
    ("86 runs on bad lines: every call right", LINES, "right"),
    ("… a crash", LINES, "crash"),
    ("… a wrong value, and no error", LINES, "wrong, silently"),
    ("… a request sent too often", LINES, "sent too often"),
    ("… a call that never returned", LINES, "hang"),
    ("720 calls, with each of 39 faults and with none: right", FAULTS, "right"),
    ("… an exception that shows a mistake in the library", FAULTS, "exception"),
    ("… wrong, and no error", FAULTS, "wrong, silently"),
    (
        "requests to move or change the arm that arrived twice or more",
        FAULTS,
        "(one-way requests that arrived twice or more)",
    ),
]


@pytest.mark.parametrize(("label", "page", "outcome"), ROWS)
def test_row_of_the_comparison_is_that_of_the_measured_page(
    label: str, page: str, outcome: str
) -> None:
    ours, theirs, *_ = cells(README, label)
    assert (int(ours), int(theirs)) == our_and_their(page, outcome)


def test_numbers_of_runs_and_calls_are_the_sums_of_the_measured_pages() -> None:
    ends = ("right", "honest error", "-1 or None", "wrong, silently")
    assert our_and_their(LINES, *ends, "crash", "sent too often", "hang") == (86, 86)
    assert our_and_their(FAULTS, *ends, "exception", "not ended") == (720, 720)
    scenarios = re.findall(
        r"^\| \S+ \|.*\|.*\|.*\|.*\|$", (ROOT / "docs" / FAULTS).read_text(), re.M
    )
    assert len(scenarios) - len(["heading", "no fault"]) == 39


def test_times_of_the_comparison_are_those_of_the_page_on_speed() -> None:
    speed = (ROOT / "docs" / "speed.md").read_text(encoding="utf-8")
    for label, row in (
        (
            "values of one reply, from its bytes",
            "| feed() of one frame, and its values | pymycobot",
        ),
        ("building the frame of `send_angles`", "| | pymycobot's building of the frame"),
    ):
        assert f"{cells(README, label)[0]} |" in speed[speed.index(row) :].splitlines()[0]


def test_links_of_the_readme_lead_to_files_of_the_repository() -> None:
    targets = re.findall(r'(?:\]\(|src="|srcset=")([^)"]+)', README)
    local = [HERE.sub("", target) for target in targets]
    assert len(local) > 30
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
