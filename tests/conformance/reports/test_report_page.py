"""The page of a whole run is short, shows failures first, and contains no markup of a device."""

from __future__ import annotations

from html.parser import HTMLParser

import pytest

from cobotwire import editions
from cobotwire.conformance import Cause, Exchange, Report, Result, Verdict
from cobotwire.conformance.provenance import identify
from cobotwire.conformance.report import Environment
from cobotwire.conformance.reports import from_json, to_html, to_json
from cobotwire.conformance.reports.grouped import by_cause
from cobotwire.conformance.reports.html_results import SIGNS
from cobotwire.conformance.statement import statement_template
from conformance.device.testing import prepared

TABLE = editions.load("mycobot280").TABLE
HOSTILE = [
    "</style><script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "\"><svg onload='x'>",
    "]]> --> <!-- &lt; &#x3c;script",
    "\u202e\x00\x1b[2J\ud800",
]


class Page(HTMLParser):
    """The elements of a page with their attributes, and its titles in their order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.titles: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        if self.tags and self.tags[-1][0] in ("h1", "h2") and data.strip():
            self.titles.append(data)


@pytest.fixture(scope="module")
def whole() -> Report:
    report = prepared(TABLE).run()
    identify(report, "mycobot280", port="memory")
    report.statement = statement_template(TABLE)
    return report


def test_page_of_a_whole_run_has_less_than_200_kilobytes(whole: Report) -> None:
    assert len(whole.results) > 850
    assert len(to_html(whole).encode()) < 200_000


def test_report_holds_what_is_needed_to_repeat_the_run(whole: Report) -> None:
    again = from_json(to_json(whole))
    assert to_json(again) == to_json(whole)
    assert len(again.edition_digest) == len(again.code_digest) == 64
    assert again.environment.port == "memory"
    assert all(vars_of(again.environment).values())
    assert again.seconds > 0


def vars_of(environment: Environment) -> dict[str, str]:
    return {name: getattr(environment, name) for name in Environment.__slots__}


def test_page_states_where_the_report_comes_from(whole: Report) -> None:
    text = to_html(whole)
    environment = vars_of(whole.environment)
    for fact in (whole.edition_digest, whole.code_digest, *environment.values()):
        assert fact in text
    assert "get_tof_distance: implemented" in text


def failing(count: int) -> Report:
    report = Report("device", "mycobot280", "arm", finished=True)
    report.results = [
        Result(
            "query-replied",
            f"get_{at}",
            Verdict.FAIL,
            f"get_{at}(joint={at}, row=(1, (2, {at}))): expected a reply; received nothing",
            (Exchange(0.5, "sent", bytes([at])),),
        )
        for at in range(count)
    ]
    other = Result("reply-once", "get_1", Verdict.FAIL, "two replies came: FE FE 02, FE FE 03")
    waiting = Result("arrives", "stop", Verdict.NOT_RUN, "It ended.", cause=Cause.RUN_ENDED)
    report.results += [other, waiting]
    return report


def test_failures_with_the_same_cause_are_one_group() -> None:
    groups = by_cause(failing(12).failures)
    assert [(group[0].case, len(group)) for group in groups] == [
        ("query-replied", 12),
        ("reply-once", 1),
    ]
    assert [result.command for result in groups[0]] == [f"get_{at}" for at in range(12)]


def test_failures_come_before_the_rest() -> None:
    page = Page(to_html(failing(12)))
    assert page.titles[:3] == [
        "device conformance: arm",
        "Failures: 13 test cases, 2 causes",
        "Not run: 1 test case",
    ]


@pytest.mark.parametrize("text", HOSTILE)
def test_text_of_a_device_is_never_markup(text: str) -> None:
    report = failing(1)
    report.subject = report.firmware = report.stopped = report.statement = text
    report.options = {text: text}
    report.tester = report.serial = text
    report.environment = Environment(text, text, text, text, text, text)
    exchange = Exchange(0.1, "received", b"<b>", text)
    report.results = [
        Result(text, text, verdict, text, (exchange,), text, further=(text,), group=text)
        for verdict in Verdict
    ]
    report.reply_seconds, report.deadline_seconds = {text: [0.1]}, {text: 0.5}
    plain, page = Page(to_html(failing(1))), Page(to_html(report))
    added = {tag for tag, _ in page.tags} - {tag for tag, _ in plain.tags}
    assert added <= {"svg", "path", "text", "title", "ul", "li", "br", "h3", "pre", "section", "b"}
    assert [tag for tag, _ in page.tags].count("script") == 1
    for _, attributes in page.tags:
        assert not [name for name in attributes if name.startswith("on") or name == "src"]
    [policy] = [a["content"] for t, a in page.tags if t == "meta" and "http-equiv" in a]
    assert policy is not None
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy


def test_failures_of_a_codec_are_grouped_without_their_values() -> None:
    report = Report("codec", "mycobot280", "codec", finished=True)
    report.results = [
        Result(
            "decode-values",
            name,
            Verdict.FAIL,
            f"decode-values/{name}/reply/x={at}: expected {{'x': {at}}}, but the answer was {at}",
        )
        for at, name in enumerate(["get_speed", "get_angles"])
    ]
    [group] = by_cause(report.failures)
    assert [result.command for result in group] == ["get_speed", "get_angles"]


@pytest.mark.parametrize("text", ["(" * 9000, "FE " * 9000, "[" * 4000 + "]" * 4000, "a/" * 9000])
def test_long_reason_is_grouped(text: str) -> None:
    # Without a limit, some of these take minutes.
    results = [Result("x", "", Verdict.FAIL, text) for _ in range(50)]
    assert len(by_cause(results)) == 1


def test_each_cause_of_an_outcome_has_a_sign() -> None:
    assert {cause for _, cause in SIGNS} == {*Cause}
