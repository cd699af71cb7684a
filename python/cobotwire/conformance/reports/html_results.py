"""The results of a report as HTML: a matrix, and each command with its evidence."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from xml.etree.ElementTree import Element

from cobotwire.conformance.hex_text import exchanged
from cobotwire.conformance.report import Cause, Exchange, Kind, Report, Result, Verdict
from cobotwire.conformance.reports.element import Child, element
from cobotwire.conformance.reports.grouped import columns, matrix, rows, title_of

# Longer texts are shortened to this many characters.
LONGEST = 200
# For a test case that passed, the page shows only the last exchanges, this many; the JSON report
# has more.
OF_PASSES = 3
# How many further failures of a test case it describes.
FURTHER = 3
ARROWS = {"sent": "→", "received": "←"}
# The sign of each outcome, in the order in which outcomes are listed.
SIGNS = {
    (Verdict.FAIL, Cause.NONE): "✗",
    (Verdict.FAIL, Cause.UNSTABLE): "≈",
    (Verdict.INCONCLUSIVE, Cause.NOT_SUPPORTED): "○",
    (Verdict.INCONCLUSIVE, Cause.NOT_TIMED): "◌",
    (Verdict.PASS, Cause.NONE): "✓",
    (Verdict.NOT_RUN, Cause.NOT_PERMITTED): "·",
    (Verdict.NOT_RUN, Cause.NOT_SELECTED): "-",
    (Verdict.NOT_RUN, Cause.RUN_ENDED): "…",
}
# The CSS class that gives an outcome its colour.
CLASSES = {Verdict.FAIL: "fail", Verdict.PASS: "pass", Verdict.INCONCLUSIVE: "open"}


def sign_of(result: Result) -> str:
    """Return the sign of an outcome; ``?`` for an unknown one of another program's report."""
    known = SIGNS.get((result.verdict, Cause.NONE), "?")
    return SIGNS.get((result.verdict, result.cause), known)


def class_of(result: Result) -> str:
    """Return the CSS class of an outcome."""
    failed = result.verdict is Verdict.FAIL
    unstable = failed and result.cause is Cause.UNSTABLE
    return "unstable" if unstable else CLASSES.get(result.verdict, "skip")


def chips(results: Iterable[Result]) -> Iterator[Child]:
    """Yield the count of each outcome: ``12 not run (not permitted)``."""
    found: dict[tuple[Verdict, Cause], list[Result]] = {}
    for result in results:
        found.setdefault((result.verdict, result.cause), []).append(result)
    known = list(SIGNS)
    for outcome in sorted(found, key=lambda o: known.index(o) if o in known else len(known)):
        first, *_ = found[outcome]
        words = f"{len(found[outcome])} {first.outcome}"
        yield from (" ", element("span", words, class_=f"chip {class_of(first)}"))


def shortened(text: str) -> str:
    """Return the start of a long text; the page shows it in full elsewhere."""
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."


def heading(id: str, title: str, more: str = "") -> Element:
    """Return a heading that the navigation links to."""
    return element("h2", f"{title}: {more}" if more else title, id=id)


def link_to(command: str) -> Element:
    """Return a link to the results of a command."""
    return element("a", title_of(command), href=f"#{_anchor(command)}")


def _anchor(command: str) -> str:
    return f"of-{command}"


def matrix_of(report: Report) -> Iterator[Element]:
    """Yield the section: a row for each command, a column for each test case."""
    cells = matrix(report)
    cases = columns(cells)
    heads = (element("th", element("span", case), scope="col") for case in cases)
    lines = []
    for command in rows(cells):
        found = [cells.get((command, case)) for case in cases]
        lines.append(element("tr", element("th", link_to(command), scope="row"), *_row(found)))
    yield heading("matrix", "Commands and test cases")
    signs = ", ".join(f"{sign} {cause or verdict}" for (verdict, cause), sign in SIGNS.items())
    yield element("p", f"{signs}. Each command links to its results.", class_="faint")
    head = element("thead", element("tr", element("th", "command"), *heads))
    table = element("table", head, element("tbody", *lines), class_="matrix")
    yield element("div", table, class_="scroll", tabindex="0")


def _row(cells: list[Result | None]) -> Iterator[Element]:
    """Yield the cells of a row. Adjacent empty cells are merged, to shorten the page."""
    for empty, group in groupby(cells, key=lambda cell: cell is None):
        found = list(group)
        if empty:
            yield element("td", colspan=len(found)) if len(found) > 1 else element("td")
        for shown in filter(None, found):
            # Most cells are a pass: the page is a tenth shorter if that is the default.
            mark = class_of(shown)
            yield element("td", sign_of(shown), **({} if mark == "pass" else {"class_": mark}))


def by_command(report: Report) -> Iterator[Element]:
    """Yield the section: one folded entry for each command, and last the entry of the line."""
    found: dict[str, list[Result]] = {}
    for result in report.results:
        found.setdefault(result.command, []).append(result)
    yield heading("commands", "Results by command")
    legend = (
        f"→ the tester sends, ← it receives; times in seconds since the start. For test "
        f"cases that passed, the last {OF_PASSES} exchanges are shown; the JSON report has more."
    )
    yield element("p", legend, class_="faint")
    for command in sorted(found, key=lambda name: name == ""):
        yield _command(report.kind, command, found[command])


def _command(kind: Kind, command: str, results: list[Result]) -> Element:
    summary = element("summary", element("code", title_of(command)), *chips(results))
    sources = dict.fromkeys(result.source for result in results if result.source)
    required = [element("p", f"spec: {', '.join(sources)}", class_="faint")] if sources else []
    steps: dict[str, list[Result]] = {}
    for result in results:
        steps.setdefault(result.group, []).append(result)
    parts = [part for group, own in steps.items() for part in _step(kind, group, own)]
    return element("details", summary, *required, *parts, id=_anchor(command))


def _step(kind: Kind, group: str, results: list[Result]) -> Iterator[Element]:
    """Yield the results of a group of test cases: those with the same reason in one line."""
    if group:
        yield element("h3", group)
    same: dict[tuple[str, str, tuple[str, ...]], list[Result]] = {}
    for result in results:
        same.setdefault((result.outcome, result.reason, result.further), []).append(result)
    for alike in same.values():
        yield _alike(alike)
        # The test cases of a group are checked by the same exchanges.
        for evidence in dict.fromkeys(r.evidence for r in alike if r.verdict is Verdict.FAIL):
            yield from _evidence(kind, evidence)
    passed = dict.fromkeys(r.evidence for r in results if r.verdict is not Verdict.FAIL)
    for evidence in passed:
        yield from _evidence(kind, evidence[-OF_PASSES:])


def _alike(results: Sequence[Result]) -> Element:
    first = results[0]
    names = ", ".join(result.case for result in results)
    head = element("b", f"{sign_of(first)} {names}", class_=class_of(first))
    also = [f"also, {shortened(text)}" for text in first.further[:FURTHER]]
    if len(first.further) > FURTHER:
        also.append("the JSON report describes more")
    lines = (element("div", text, class_="faint") for text in also)
    return element("div", head, f" {first.explained}", *lines)


def _evidence(kind: Kind, exchanges: Sequence[Exchange]) -> Iterator[Element]:
    if exchanges:
        yield element("pre", *(part for exchange in exchanges for part in _line(kind, exchange)))


def _line(kind: Kind, exchange: Exchange) -> Iterator[Child]:
    note = f"  {exchange.note}" if exchange.note else ""
    head = f"{exchange.at:.3f} {ARROWS.get(exchange.direction, exchange.direction)} "
    yield f"{head}{exchanged(kind, exchange)}{note}"
    yield element("br")
