"""Reports: whatever a run found is in every form of its report, and nothing else is."""

from __future__ import annotations

from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.conformance import Exchange, Report, Result, Verdict
from cobotwire.conformance.reports import compare, from_json, to_html, to_json, to_junit
from cobotwire.conformance.reports.matrix import GRAVEST, matrix
from cobotwire.errors import UsageError

BAD = {Verdict.FAIL, Verdict.UNSTABLE}
# Whatever a device or a codec under test may have said stands in a reason.
TEXT = st.text(max_size=30) | st.sampled_from(
    ["<script>alert(1)</script>", "a & b", "\x00\x1b[31m"]
)
SECONDS = st.floats(0, 5)
EXCHANGES = st.builds(
    Exchange,
    SECONDS.map(lambda at: round(at, 6)),
    st.sampled_from(["sent", "heard"]),
    st.binary(max_size=20),
    TEXT,
)
RESULTS = st.builds(
    Result,
    st.sampled_from(["reply-once", "read-back", "unknown-id"]),
    st.sampled_from(["", "get_angles", "set_color", "stop"]),
    st.sampled_from(Verdict),
    TEXT,
    st.lists(EXCHANGES, max_size=3).map(tuple),
    st.sampled_from(["", "spec/commands/motion.yaml:12"]),
)
TIMES = st.dictionaries(st.sampled_from(["get_angles", "stop"]), st.lists(SECONDS, max_size=5))
REPORTS = st.builds(
    Report,
    st.sampled_from(["device", "client", "codec"]),
    st.just("mycobot280"),
    TEXT,
    st.just("2026-11-21T12:00:00+00:00"),
    TEXT,
    st.booleans(),
    st.lists(RESULTS, max_size=12),
    TIMES,
    st.dictionaries(st.sampled_from(["get_angles", "stop"]), st.floats(0.01, 2)),
)


class Found(HTMLParser):
    """What a page has: ids, links, what it loads, and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.scripts = 0
        self.loads: list[str] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.scripts += tag == "script"
        self.ids += [given["id"] or ""] if "id" in given else []
        self.links += [given["href"] or ""] if tag == "a" else []
        self.loads += [value or "" for name, value in attrs if name == "src" or tag == "link"]

    def handle_data(self, data: str) -> None:
        self.text += data


@given(REPORTS)
def test_json_gives_back_the_report(report: Report) -> None:
    assert from_json(to_json(report)) == report


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"format": "other", "version": 1}', "nonsense"])
def test_what_is_no_report_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="report"):
        from_json(text)


@given(REPORTS)
def test_the_page_shows_every_cell_and_result_and_loads_nothing(report: Report) -> None:
    page = Found(to_html(report))
    cells = matrix(report)
    assert sorted(page.ids) == sorted(f"{cell.rule}-{cell.command}" for cell in cells.values())
    assert {link.removeprefix("#") for link in page.links} == set(page.ids)
    assert page.loads == []
    assert page.scripts == 1, "what a device says is text, never a script"
    for result in report.results:
        assert _shown(result.reason) in page.text
        for exchange in result.evidence:
            assert report.kind == "codec" or exchange.data.hex(" ").upper() in page.text


def _shown(text: str) -> str:
    """A page's parser reads line ends as one, and knows no NUL."""
    return text.replace("\r\n", "\n").replace("\r", "\n")


@given(REPORTS)
def test_junit_counts_every_cell_once(report: Report) -> None:
    root = ElementTree.fromstring(to_junit(report).encode())
    cells = matrix(report).values()
    suites = root.findall("testsuite")
    run = 0 if report.finished else 1
    assert sum(int(suite.get("tests", "")) for suite in suites) == len(cells) + run
    assert len(root.findall(".//testcase")) == len(cells) + run
    bad = sum(cell.verdict in BAD for cell in cells)
    assert len(root.findall(".//failure")) == bad
    assert sum(int(suite.get("failures", "")) for suite in suites) == bad
    skipped = sum(int(suite.get("skipped", "")) for suite in suites)
    assert skipped == len(root.findall(".//skipped"))
    assert len(root.findall(".//error")) == run


@given(REPORTS)
def test_a_cell_shows_its_gravest_result(report: Report) -> None:
    for (command, rule), cell in matrix(report).items():
        verdicts = [r.verdict for r in report.results if (r.command, r.rule) == (command, rule)]
        assert cell.verdict == min(verdicts, key=GRAVEST.index)


@given(REPORTS)
def test_a_report_does_not_differ_from_itself(report: Report) -> None:
    found = compare(report, report)
    assert found.changes == ()
    assert found.times == ()
    assert not found.worse


@given(REPORTS, REPORTS)
def test_what_differs_is_told_once_each_way(one: Report, other: Report) -> None:
    other.kind = one.kind
    there, back = compare(one, other), compare(other, one)
    mine, theirs = matrix(one), matrix(other)
    differing = {
        place
        for place in {*mine, *theirs}
        if place not in mine or place not in theirs or mine[place].verdict != theirs[place].verdict
    }
    assert {(change.command, change.rule) for change in there.changes} == differing
    assert len(there.changes) == len(back.changes) == len(differing)
    fixed = {(c.command, c.rule) for c in there.changes if c.kind == "better"}
    assert fixed <= {(c.command, c.rule) for c in back.changes if c.kind == "worse"}


@given(REPORTS, REPORTS)
def test_a_new_failure_is_always_worse(one: Report, other: Report) -> None:
    other.kind = one.kind
    mine, theirs = matrix(one), matrix(other)
    newly = [
        place
        for place, cell in theirs.items()
        if cell.verdict in BAD and (place not in mine or mine[place].verdict not in BAD)
    ]
    lost = [
        place
        for place, cell in mine.items()
        if cell.verdict is Verdict.PASS
        and (place not in theirs or theirs[place].verdict is not Verdict.PASS)
    ]
    assert compare(one, other).worse == bool(newly or lost)


def test_reports_of_other_kinds_are_not_compared() -> None:
    one, other = Report("device", "mycobot", "a", ""), Report("codec", "mycobot", "b", "")
    with pytest.raises(UsageError, match="kind"):
        compare(one, other)
