"""Write reports as one self-contained HTML page: the summary first, then causes, then evidence."""

from __future__ import annotations

from base64 import b64encode
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cache
from hashlib import sha256
from importlib.resources import files
from xml.etree.ElementTree import Element

from cobotwire.conformance.catalogue.listing import SUITES
from cobotwire.conformance.host import clock_mistake
from cobotwire.conformance.report import Kind, Report, Result, Verdict
from cobotwire.conformance.reports.as_json import report_digest
from cobotwire.conformance.reports.element import Child, element, page
from cobotwire.conformance.reports.grouped import by_cause, title_of
from cobotwire.conformance.reports.html_results import (
    by_command,
    chips,
    class_of,
    heading,
    link_to,
    matrix_of,
    shortened,
    sign_of,
)
from cobotwire.conformance.reports.times import times_plot
from cobotwire.protocol.counted import counted

HERE = files("cobotwire.conformance.reports")
# A group of failures with more commands is folded.
UNFOLDED = 3


def to_html(report: Report) -> str:
    """Return a report as a page. It loads nothing, so that it can be mailed and archived."""
    title = f"{report.kind} conformance: {report.subject}"
    style, script = _file("page.css"), _file("page.js")
    # Only the page's own style and script have an effect, whatever a device has sent.
    policy = f"default-src 'none'; style-src {_hash(style)}; script-src {_hash(script)}"
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", http_equiv="Content-Security-Policy", content=policy),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", title),
        element("style", style),
    )
    parts = [*_head(report, title), *_causes(report), *_origin(report), *_statement(report)]
    parts += [*matrix_of(report), *by_command(report), *_times(report), *_cases(report)]
    titles = [part for part in parts if part.tag == "h2"]
    # After the facts, which come first.
    parts.insert([part.tag for part in parts].index("dl") + 1, _navigation(titles))
    return page(head, element("body", *parts, element("script", script)))


def _file(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    return f"'sha256-{b64encode(sha256(text.encode()).digest()).decode()}'"


def _head(report: Report, title: str) -> Iterator[Element]:
    yield element("h1", title)
    if not report.finished:
        why = f": {report.stopped}" if report.stopped else ""
        yield _banner("unstable", f"The run is incomplete{why}.")
    if report.failures:
        yield _banner("fail", "It does not conform.")
    elif report.finished:
        yield _banner("pass", "It conforms as far as it was tested.")
    if report.untested:
        yield _banner("unstable", report.untested)
    yield element("p", *chips(report.results))
    facts = {
        "edition": report.edition,
        "firmware": (report.firmware or "not reported") if report.kind == "device" else "",
        "started": f"{report.started}, {report.seconds:.1f} s",
        "catalogue": f"version {report.catalogue}" if report.catalogue else "",
        "tester": report.tester,
        "serial number": report.serial and f"{report.serial} (a hash)",
        "clocks": clock_mistake(report.host),
        "options": _options(report) or "none: only what needs no permission",
    }
    yield _terms(facts)


def _options(report: Report) -> str:
    return ", ".join(f"{name} {text}" for name, text in report.options.items())


def _terms(facts: dict[str, str]) -> Element:
    known = ((name, text) for name, text in facts.items() if text)
    return element("dl", *(element(*pair) for n, t in known for pair in (("dt", n), ("dd", t))))


def _banner(kind: str, text: str) -> Element:
    return element("p", text, class_=f"banner {kind}")


def _navigation(titles: Sequence[Element]) -> Element:
    links: list[Child] = []
    for title in titles:
        name = (title.text or "").partition(":")[0]
        links += [element("a", name, href=f"#{title.get('id')}"), " "]
    return element("nav", *links)


@cache
def _purposes(kind: Kind) -> dict[str, str]:
    """Return the purpose of each test case for a kind of subject."""
    return {case.id: case.purpose for suite in SUITES if suite.kind == kind for case in suite.cases}


def _causes(report: Report) -> Iterator[Element]:
    """Yield failures and inconclusive test cases by cause, then what was not run."""
    known = _purposes(report.kind)
    for verdict, title in (
        (Verdict.FAIL, "Failures"),
        (Verdict.INCONCLUSIVE, "Inconclusive"),
    ):
        found = [result for result in report.results if result.verdict is verdict]
        groups = by_cause(found)
        if groups:
            size = f"{counted(len(found), 'test case')}, {counted(len(groups), 'cause')}"
            yield heading(title.lower(), title, size)
        yield from (_cause(group, known.get(group[0].case, "")) for group in groups)
    left = [result for result in report.results if result.verdict is Verdict.NOT_RUN]
    if left:
        yield heading("not-run", "Not run", counted(len(left), "test case"))
        counts = Counter(result.reason for result in left)
        lines = (element("li", f"{count}: {text}") for text, count in counts.most_common())
        yield element("ul", *lines)


def _cause(results: Sequence[Result], purpose: str) -> Element:
    first = results[0]
    count = f" ({len(results)})" if len(results) > 1 else ""
    mark = class_of(first)
    sign = element("b", f"{sign_of(first)} {first.case}{count}", class_=mark)
    head = element("p", sign, f" {purpose}")
    items = [element("li", link_to(r.command), f" {shortened(r.reason)}") for r in results]
    if len(items) <= UNFOLDED:
        return element("section", head, element("ul", *items), class_=mark)
    commands = list(dict.fromkeys(result.command for result in results))[1:]
    names = element("summary", f"and {len(items) - 1} more: {_names(commands)}")
    rest = element("details", names, element("ul", *items[1:]))
    return element("section", head, element("ul", items[0]), rest, class_=mark)


def _names(commands: Sequence[str]) -> str:
    return ", ".join(map(title_of, commands[:6])) + (", ..." if len(commands) > 6 else "")


def _origin(report: Report) -> Iterator[Element]:
    """Yield what is needed to understand and repeat the run."""
    if not report.code_digest:
        return
    environment, host = report.environment, report.host
    subject = "device URL" if report.kind == "device" else report.kind
    facts = {
        "edition": f"{report.edition}, SHA-256 {report.edition_digest}",
        "code": f"SHA-256 {report.code_digest}",
        "host": environment.host,
        "system": environment.system,
        "Python": environment.python,
        "cobotwire": f"{environment.package}, {environment.codec} codec",
        "port": environment.port,
        "host load": f"{host.load_at_start:.2f} at the start, {host.load_at_end:.2f} at the end",
        "run time": f"{host.monotonic_seconds} s by the monotonic clock, {host.wall_seconds} s by "
        "the wall clock",
        "report": f"SHA-256 {report_digest(report)}: the digest of the report in JSON",
        "order": "as listed; nothing is drawn at random",
        "repeat": f"cobotwire --edition {report.edition} conform {subject} --again REPORT.json",
    }
    summary = element("summary", "Where this report comes from, and how to repeat the run")
    yield element("details", summary, _terms(facts))


def _statement(report: Report) -> Iterator[Element]:
    if report.statement:
        summary = element("summary", "Implementation conformance statement")
        lines = report.statement.splitlines()
        text = (part for line in lines for part in (line, element("br")))
        yield element("details", summary, element("pre", *text))


def _cases(report: Report) -> Iterator[Element]:
    """Yield the purpose of each test case of the report."""
    known = _purposes(report.kind)
    ids = dict.fromkeys(result.case for result in report.results)
    if any(id in known for id in ids):
        yield heading("cases", "Test cases")
        clauses = {id: f"{report.clauses[id]} {id}" if id in report.clauses else id for id in ids}
        yield _terms({clauses[id]: known.get(id, "") for id in ids})


def _times(report: Report) -> Iterator[Element]:
    if any(report.reply_seconds.values()):
        yield heading("times", "Reply times")
        legend = (
            "A line from the fastest to the slowest, a bar for the middle nine tenths, a mark at "
            "the median; red: the deadline."
        )
        yield element("p", legend, class_="faint")
        yield element("div", times_plot(report), class_="scroll", tabindex="0")
