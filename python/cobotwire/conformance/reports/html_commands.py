"""The results of each command as HTML, with the bytes that were exchanged."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element

from cobotwire.conformance.report import Exchange, Kind, Report, Result, Verdict
from cobotwire.conformance.reports.element import element
from cobotwire.conformance.reports.evidence import shown
from cobotwire.conformance.reports.html_parts import (
    anchor,
    class_of,
    heading,
    order_of,
    shortened,
    sign_of,
    title_of,
    words_of,
)

# The last exchanges that the page shows of what passed; the JSON report has more.
OF_PASSES = 3
# How many further failures of a test case it describes.
FURTHER = 3
ARROWS = {"sent": "→", "received": "←"}


def by_command(report: Report) -> Iterator[Element]:
    """Yield the section: one folded entry for each command, that of the line last."""
    found: dict[str, list[Result]] = {}
    for result in report.results:
        found.setdefault(result.command, []).append(result)
    yield heading("commands", "Results by command")
    legend = (
        f"→ the tester sends, ← it receives; times in seconds since the start. Of what passed, the "
        f"last {OF_PASSES} exchanges are shown; the JSON report has more."
    )
    yield element("p", legend, class_="faint")
    for command in sorted(found, key=lambda name: name == ""):
        yield _command(report.kind, command, found[command])


def _command(kind: Kind, command: str, results: list[Result]) -> Element:
    counts = Counter((result.verdict, result.cause) for result in results)
    marks: list[Element | str] = []
    for outcome in sorted(counts, key=order_of):
        words = words_of(counts[outcome], outcome)
        marks += [" ", element("span", words, class_=f"chip {class_of(*outcome)}")]
    summary = element("summary", element("code", title_of(command)), *marks)
    sources = dict.fromkeys(result.source for result in results if result.source)
    required = [element("p", f"spec: {', '.join(sources)}", class_="faint")] if sources else []
    steps: dict[str, list[Result]] = {}
    for result in results:
        steps.setdefault(result.group, []).append(result)
    parts = [part for group, own in steps.items() for part in _step(kind, group, own)]
    return element("details", summary, *required, *parts, id=anchor(command))


def _step(kind: Kind, group: str, results: list[Result]) -> Iterator[Element]:
    """Yield the results of a group of test cases: those with the same reason in one line."""
    if group:
        yield element("h3", group)
    same: dict[tuple[Verdict, str, str, tuple[str, ...]], list[Result]] = {}
    for result in results:
        key = (result.verdict, result.outcome, result.reason, result.further)
        same.setdefault(key, []).append(result)
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
    mark = sign_of(first.verdict, first.cause)
    head = element("b", f"{mark} {names}", class_=class_of(first.verdict, first.cause))
    also = [f"also, {shortened(text)}" for text in first.further[:FURTHER]]
    if len(first.further) > FURTHER:
        also.append("the JSON report describes more")
    lines = (element("div", text, class_="faint") for text in also)
    return element("div", head, f" {first.reason}", *lines)


def _evidence(kind: Kind, exchanges: Sequence[Exchange]) -> Iterator[Element]:
    if exchanges:
        yield element("pre", *(part for exchange in exchanges for part in _line(kind, exchange)))


def _line(kind: Kind, exchange: Exchange) -> Iterator[Element | str]:
    note = f"  {exchange.note}" if exchange.note else ""
    head = f"{exchange.at:.3f} {ARROWS.get(exchange.direction, exchange.direction)} "
    yield f"{head}{shown(kind, exchange)}{note}"
    yield element("br")
