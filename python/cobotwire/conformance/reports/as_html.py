"""Reports as one HTML page that needs nothing else: the matrix, and what stands behind it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from importlib.resources import files
from xml.etree.ElementTree import Element

from cobotwire.conformance.report import Report, Result, Verdict
from cobotwire.conformance.reports.element import element, page
from cobotwire.conformance.reports.evidence import said
from cobotwire.conformance.reports.matrix import LINE, Cell, Place, commands, matrix, rules
from cobotwire.conformance.reports.times import times_plot

SIGNS = {
    Verdict.PASS: "✓",
    Verdict.FAIL: "✗",
    Verdict.UNSTABLE: "≈",
    Verdict.NOT_ALLOWED: "·",
    Verdict.NOT_SUPPORTED: "○",
}
HERE = files("cobotwire.conformance.reports")
BAD = (Verdict.FAIL, Verdict.UNSTABLE)


def to_html(report: Report) -> str:
    """A report as a page. It loads nothing, so that it can be kept, mailed and archived."""
    cells = matrix(report)
    title = f"{report.kind} conformance: {report.subject}"
    viewport = element("meta", name="viewport", content="width=device-width, initial-scale=1")
    head = element(
        "head",
        element("meta", charset="utf-8"),
        viewport,
        element("title", title),
        element("style", _file("page.css")),
    )
    parts = [*_head(report, title), *_failures(report, cells), *_matrix(cells), *_times(report)]
    parts += [element("h2", "Evidence"), *(_details(report, cell) for cell in cells.values())]
    return page(head, element("body", *parts, element("script", _file("page.js"))))


def _file(name: str) -> str:
    """What the page carries in itself."""
    return (HERE / name).read_text(encoding="utf-8")


def _head(report: Report, title: str) -> Iterator[Element]:
    yield element("h1", title)
    facts = {
        "edition": report.edition,
        "firmware": report.firmware or "not told",
        "began": report.began,
        "results": _counts(report),
    }
    terms = (part for name, text in facts.items() for part in (("dt", name), ("dd", text)))
    yield element("dl", *(element(tag, text) for tag, text in terms))
    if not report.finished:
        yield _banner(
            "unstable", "The run did not come to its end: what is not here was not tested."
        )
    elif report.conforms:
        yield _banner("pass", "It conforms, as far as it was tested.")
    else:
        yield _banner("fail", "It does not conform.")


def _counts(report: Report) -> str:
    counts = Counter(result.verdict for result in report.results)
    return ", ".join(f"{counts[v]} {v.value}" for v in Verdict if counts[v]) or "none"


def _banner(kind: str, text: str) -> Element:
    return element("p", text, class_=f"banner {kind}")


def _failures(report: Report, cells: dict[Place, Cell]) -> Iterator[Element]:
    bad = [cell for cell in cells.values() if cell.verdict in BAD]
    if bad:
        yield element("h2", f"What is wrong ({len(bad)})")
    for cell in bad:
        result = next(result for result in cell.results if result.verdict is cell.verdict)
        link = element("a", f"{_name(cell)}, {cell.rule}", href=f"#{_anchor(cell)}")
        verdict = element(
            "span", f"{cell.verdict.value} ", class_=f"verdict {_class(cell.verdict)}"
        )
        yield element("p", verdict, link, element("br"), result.reason, class_="reason")


def _matrix(cells: dict[Place, Cell]) -> Iterator[Element]:
    columns = rules(cells)
    heads = (element("th", element("span", rule), scope="col") for rule in columns)
    rows = []
    for command in commands(cells):
        name = element("th", element("code", command or "the line"), scope="row")
        found = (cells.get((command, rule)) for rule in columns)
        rows.append(element("tr", name, *map(_cell, found)))
    table = element(
        "table",
        element("thead", element("tr", element("th", "command"), *heads)),
        element("tbody", *rows),
        class_="matrix",
    )
    yield element("h2", "Commands and rules")
    legend = ", ".join(f"{sign} {verdict.value}" for verdict, sign in SIGNS.items())
    yield element("p", legend, class_="faint")
    yield element("div", table, class_="scroll")


def _cell(cell: Cell | None) -> Element:
    if cell is None:
        return element("td")
    link = element(
        "a",
        SIGNS[cell.verdict],
        href=f"#{_anchor(cell)}",
        title=f"{_name(cell)}, {cell.rule}: {cell.verdict.value}",
    )
    return element("td", link, class_=_class(cell.verdict))


def _times(report: Report) -> Iterator[Element]:
    if any(report.reply_seconds.values()):
        yield element("h2", "Reply times")
        legend = (
            "A line from the fastest to the slowest, a box around the middle nine tenths, a mark"
        )
        yield element("p", f"{legend} at the median; red: the deadline.", class_="faint")
        yield element("div", times_plot(report), class_="scroll")


def _details(report: Report, cell: Cell) -> Element:
    """A cell's results; what is wrong is unfolded."""
    verdict = element("span", cell.verdict.value, class_=f"verdict {_class(cell.verdict)}")
    summary = element("summary", verdict, f" {_name(cell)}, {cell.rule}")
    parts = [part for result in cell.results for part in _result(report, result)]
    found = element("details", summary, *parts, id=_anchor(cell))
    if cell.verdict in BAD:
        found.set("open", "open")
    return found


def _result(report: Report, result: Result) -> Iterator[Element]:
    yield element("p", result.reason, class_="reason")
    if result.source:
        yield element("p", "the spec: ", element("code", result.source), class_="faint")
    rows = [
        element(
            "tr",
            element("td", f"{exchange.at:.4f} s"),
            element("td", exchange.direction, class_=exchange.direction),
            element("td", said(report, exchange), class_="bytes"),
            element("td", exchange.note, class_="faint"),
        )
        for exchange in result.evidence
    ]
    if rows:
        yield element("div", element("table", *rows, class_="evidence"), class_="scroll")


def _name(cell: Cell) -> str:
    return "the line" if cell.command == LINE else cell.command


def _class(verdict: Verdict) -> str:
    return verdict.value.replace(" ", "-")


def _anchor(cell: Cell) -> str:
    return f"{cell.rule}-{cell.command}"
