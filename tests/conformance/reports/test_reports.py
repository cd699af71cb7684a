"""Every format of a report shows all results of a run, and nothing else."""

from __future__ import annotations

import json
from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire.conformance import Cause, Exchange, Report, Result, Verdict
from cobotwire.conformance.reports import compare, from_json, to_html, to_json, to_junit
from cobotwire.conformance.reports.grouped import GRAVEST, matrix
from cobotwire.conformance.reports.html_results import OF_PASSES
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.printable import printable

# The causes that go with each verdict.
OUTCOMES = [
    (Verdict.PASS, Cause.NONE),
    (Verdict.FAIL, Cause.NONE),
    (Verdict.FAIL, Cause.UNSTABLE),
    (Verdict.INCONCLUSIVE, Cause.NOT_SUPPORTED),
    (Verdict.NOT_RUN, Cause.NOT_PERMITTED),
    (Verdict.NOT_RUN, Cause.NOT_SELECTED),
    (Verdict.NOT_RUN, Cause.RUN_ENDED),
]
# A reason may quote anything that a device or a codec under test has sent.
TEXT = st.text(max_size=30) | st.sampled_from(
    ["<script>alert(1)</script>", "a & b", "\x00\x1b[31m", "a\r", "a\r\nb\n", "\n a"]
)
SECONDS = st.floats(0, 5)
EXCHANGES = st.builds(
    Exchange,
    SECONDS.map(lambda at: round(at, 6)),
    st.sampled_from(["sent", "received"]),
    st.binary(max_size=20),
    TEXT,
)
RESULTS = st.builds(
    lambda outcome, **fields: Result(verdict=outcome[0], cause=outcome[1], **fields),
    st.sampled_from(OUTCOMES),
    case=st.sampled_from(["reply-once", "read-back", "unknown-id"]),
    command=st.sampled_from(["", "get_angles", "set_color", "stop"]),
    reason=TEXT,
    evidence=st.lists(EXCHANGES, max_size=3).map(tuple),
    source=st.sampled_from(["", "spec/commands/motion.yaml:12"]),
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
    """The ids, links, loaded resources and text of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.scripts = 0
        self.loads: list[str] = []
        self.text = ""
        # The open elements; at the end, the elements that were never closed.
        self.unclosed: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.unclosed += [] if tag in ("meta", "br") else [tag]
        self.scripts += tag == "script"
        self.ids += [given["id"] or ""] if "id" in given else []
        self.links += [given["href"] or ""] if tag == "a" else []
        self.loads += [value or "" for name, value in attrs if name == "src" or tag == "link"]

    def handle_endtag(self, tag: str) -> None:
        assert self.unclosed.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


@given(REPORTS)
def test_report_survives_json(report: Report) -> None:
    assert from_json(to_json(report)) == report


@pytest.mark.parametrize(
    ("written", "wrong"),
    [
        ('"seconds": 0.0', '"seconds": NaN'),
        ('"seconds": 0.0', '"seconds": Infinity'),
        ('"subject": "arm"', '"subject": 1'),
        ('"results": []', '"results": {}'),
        ('"finished": false', '"finished": "no"'),
    ],
)
def test_report_with_a_value_of_another_type_is_rejected(written: str, wrong: str) -> None:
    text = to_json(Report("device", "mycobot280", "arm"))
    assert written in text
    with pytest.raises(UsageError, match="not a report in JSON"):
        from_json(text.replace(written, wrong))


NOT_A_REPORT = ["", "{}", "[]", '{"format": "other", "version": 1}', "nonsense", "[" * 100_000]


@pytest.mark.parametrize("text", NOT_A_REPORT, ids=range(6))
def test_text_that_is_not_a_report_is_rejected(text: str) -> None:
    with pytest.raises(UsageError, match="report"):
        from_json(text)


WRONG = st.sampled_from([None, True, 1, 10**400, 0.5, "x", "\ud800", [], [1], {}, {"x": [None]}])


@given(REPORTS, WRONG, st.data())
def test_report_with_a_wrong_value_is_rejected_or_can_be_compared(
    report: Report, wrong: object, data: st.DataObject
) -> None:
    document = json.loads(to_json(report))
    # A report with a digest is rejected after any change.
    del document["digest"]
    place = document
    while data.draw(st.booleans()):
        inner = [place[key] for key in (place if isinstance(place, dict) else range(len(place)))]
        places = [value for value in inner if isinstance(value, dict | list) and value]
        if not places:
            break
        place = data.draw(st.sampled_from(places))
    keys = sorted(place) if isinstance(place, dict) else range(len(place))
    place[data.draw(st.sampled_from(keys))] = wrong
    try:
        found = from_json(json.dumps(document))
    except UsageError:
        return
    found.kind = report.kind
    assert len(compare(report, found).changes) == len(compare(found, report).changes)
    to_html(found).encode()
    to_junit(found).encode()


@given(REPORTS)
def test_page_shows_every_result_and_loads_nothing(report: Report) -> None:
    page = Found(to_html(report))
    assert len(set(page.ids)) == len(page.ids)
    assert {link.removeprefix("#") for link in page.links} == set(page.ids)
    places = {id for id in page.ids if id.startswith("of-")}
    assert places == {f"of-{result.command}" for result in report.results}
    assert page.loads == []
    assert page.scripts == 1, "what a device sends is text, never a script"
    assert page.unclosed == []
    for result in report.results:
        assert printable(result.reason) in page.text
        failed = result.verdict is Verdict.FAIL
        for exchange in result.evidence if failed else result.evidence[-OF_PASSES:]:
            assert report.kind == "codec" or exchange.data.hex(" ").upper() in page.text


@given(REPORTS)
def test_junit_counts_every_cell_once(report: Report) -> None:
    root = ElementTree.fromstring(to_junit(report).encode())
    cells = matrix(report).values()
    suites = root.findall("testsuite")
    run = 0 if report.finished else 1
    assert sum(int(suite.get("tests", "")) for suite in suites) == len(cells) + run
    assert len(root.findall(".//testcase")) == len(cells) + run
    bad = sum(cell.verdict is Verdict.FAIL for cell in cells)
    assert len(root.findall(".//failure")) == bad
    assert sum(int(suite.get("failures", "")) for suite in suites) == bad
    skipped = sum(int(suite.get("skipped", "")) for suite in suites)
    assert skipped == len(root.findall(".//skipped"))
    assert len(root.findall(".//error")) == run


@given(REPORTS)
def test_cell_shows_its_most_severe_result(report: Report) -> None:
    for (command, case), cell in matrix(report).items():
        verdicts = [r.verdict for r in report.results if (r.command, r.case) == (command, case)]
        assert cell.verdict == min(verdicts, key=GRAVEST.index)


@given(REPORTS, REPORTS)
def test_each_difference_is_listed_once_in_both_directions(one: Report, other: Report) -> None:
    other.kind = one.kind
    there, back = compare(one, other), compare(other, one)
    mine, theirs = matrix(one), matrix(other)
    differing = {
        place
        for place in {*mine, *theirs}
        if place not in mine or place not in theirs or mine[place].outcome != theirs[place].outcome
    }
    assert {(change.command, change.case) for change in there.changes} == differing
    assert len(there.changes) == len(back.changes) == len(differing)
    fixed = {(c.command, c.case) for c in there.changes if c.kind == "better"}
    assert fixed <= {(c.command, c.case) for c in back.changes if c.kind == "worse"}


@given(REPORTS, REPORTS)
def test_new_failure_or_lost_pass_is_worse(one: Report, other: Report) -> None:
    other.kind = one.kind
    mine, theirs = matrix(one), matrix(other)
    newly = [
        place
        for place, cell in theirs.items()
        if cell.verdict is Verdict.FAIL
        and (place not in mine or mine[place].verdict is not Verdict.FAIL)
    ]
    lost = [
        place
        for place, cell in mine.items()
        if cell.verdict is Verdict.PASS
        and (place not in theirs or theirs[place].verdict is not Verdict.PASS)
    ]
    assert compare(one, other).worse == bool(newly or lost)


def test_reports_of_different_kinds_are_not_compared() -> None:
    one, other = Report("device", "mycobot", "a", ""), Report("codec", "mycobot", "b", "")
    with pytest.raises(UsageError, match="kind"):
        compare(one, other)
