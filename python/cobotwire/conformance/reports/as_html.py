"""Write reports as one self-contained HTML page: the matrix, and the evidence for each cell."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from importlib.resources import files
from xml.etree.ElementTree import Element

from cobotwire.conformance.report import Cause, Report, Result, Verdict
from cobotwire.conformance.reports.element import element, page
from cobotwire.conformance.reports.evidence import shown
from cobotwire.conformance.reports.matrix import (
    LINE,
    Cell,
    Place,
    case_ids,
    commands,
    matrix,
)
from cobotwire.conformance.reports.times import times_plot

SIGNS = {
    (Verdict.PASS, Cause.NONE): "✓",
    (Verdict.FAIL, Cause.NONE): "✗",
    (Verdict.FAIL, Cause.UNSTABLE): "≈",
    (Verdict.INCONCLUSIVE, Cause.NOT_PERMITTED): "·",
    (Verdict.INCONCLUSIVE, Cause.NOT_SUPPORTED): "○",
}
HERE = files("cobotwire.conformance.reports")


def to_html(report: Report) -> str:
    """Return a report as a page. It loads nothing, so that it can be mailed and archived."""
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
    return (HERE / name).read_text(encoding="utf-8")


def _head(report: Report, title: str) -> Iterator[Element]:
    yield element("h1", title)
    facts = {
        "edition": report.edition,
        "firmware": report.firmware or "unknown",
        "started": report.started,
        "results": _counts(report),
    }
    terms = (part for name, text in facts.items() for part in (("dt", name), ("dd", text)))
    yield element("dl", *(element(tag, text) for tag, text in terms))
    if not report.finished:
        yield _banner("unstable", "The run was interrupted: anything not listed was not tested.")
    elif report.conforms:
        yield _banner("pass", "It conforms as far as it was tested.")
    else:
        yield _banner("fail", "It does not conform.")


def _counts(report: Report) -> str:
    counts = Counter(result.outcome for result in report.results)
    return ", ".join(f"{count} {outcome}" for outcome, count in counts.items()) or "none"


def _banner(kind: str, text: str) -> Element:
    return element("p", text, class_=f"banner {kind}")


def _failures(report: Report, cells: dict[Place, Cell]) -> Iterator[Element]:
    failed = [cell for cell in cells.values() if cell.verdict is Verdict.FAIL]
    if failed:
        yield element("h2", f"Failures ({len(failed)})")
    for cell in failed:
        link = element("a", f"{_name(cell)}, {cell.case}", href=f"#{_anchor(cell)}")
        verdict = element("span", f"{cell.outcome} ", class_=f"verdict {_class(cell)}")
        yield element("p", verdict, link, element("br"), cell.gravest.reason, class_="reason")


def _matrix(cells: dict[Place, Cell]) -> Iterator[Element]:
    columns = case_ids(cells)
    heads = (element("th", element("span", case), scope="col") for case in columns)
    rows = []
    for command in commands(cells):
        name = element("th", element("code", command or "the line"), scope="row")
        found = (cells.get((command, case)) for case in columns)
        rows.append(element("tr", name, *map(_cell, found)))
    table = element(
        "table",
        element("thead", element("tr", element("th", "command"), *heads)),
        element("tbody", *rows),
        class_="matrix",
    )
    yield element("h2", "Commands and test cases")
    legend = ", ".join(f"{sign} {cause or verdict}" for (verdict, cause), sign in SIGNS.items())
    yield element("p", legend, class_="faint")
    yield element("div", table, class_="scroll")


def _cell(cell: Cell | None) -> Element:
    if cell is None:
        return element("td")
    link = element(
        "a",
        SIGNS[cell.verdict, cell.gravest.cause],
        href=f"#{_anchor(cell)}",
        title=f"{_name(cell)}, {cell.case}: {cell.outcome}",
    )
    return element("td", link, class_=_class(cell))


def _times(report: Report) -> Iterator[Element]:
    if any(report.reply_seconds.values()):
        yield element("h2", "Reply times")
        legend = (
            "A line from the fastest to the slowest, a box around the middle nine tenths, a mark"
        )
        yield element("p", f"{legend} at the median; red: the deadline.", class_="faint")
        yield element("div", times_plot(report), class_="scroll")


def _details(report: Report, cell: Cell) -> Element:
    """Return the results of a cell; failures are unfolded."""
    verdict = element("span", cell.outcome, class_=f"verdict {_class(cell)}")
    summary = element("summary", verdict, f" {_name(cell)}, {cell.case}")
    parts = [part for result in cell.results for part in _result(report, result)]
    found = element("details", summary, *parts, id=_anchor(cell))
    if cell.verdict is Verdict.FAIL:
        found.set("open", "open")
    return found


def _result(report: Report, result: Result) -> Iterator[Element]:
    yield element("p", result.reason, class_="reason")
    for also in result.further:
        yield element("p", f"also, {also}", class_="faint")
    if result.source:
        yield element("p", "required by ", element("code", result.source), class_="faint")
    rows = [
        element(
            "tr",
            element("td", f"{exchange.at:.4f} s"),
            element("td", exchange.direction, class_=exchange.direction),
            element("td", shown(report.kind, exchange), class_="bytes"),
            element("td", exchange.note, class_="faint"),
        )
        for exchange in result.evidence
    ]
    if rows:
        yield element("div", element("table", *rows, class_="evidence"), class_="scroll")


def _name(cell: Cell) -> str:
    return "the line" if cell.command == LINE else cell.command


def _class(cell: Cell) -> str:
    return (cell.gravest.cause or cell.verdict).replace(" ", "-")


def _anchor(cell: Cell) -> str:
    return f"{cell.case}-{cell.command}"
