"""Write reports as JUnit XML for build servers: one suite per test case, one entry per command."""

from __future__ import annotations

from xml.etree import ElementTree

from cobotwire.conformance.report import Report, Result, Verdict
from cobotwire.conformance.reports.evidence import evidence_lines
from cobotwire.conformance.reports.matrix import Cell, case_ids, matrix
from cobotwire.protocol.printable import printable

SKIPPED = (Verdict.INCONCLUSIVE, Verdict.NOT_RUN)


def to_junit(report: Report) -> str:
    """Return a report as JUnit XML. What is inconclusive or was not run counts as skipped."""
    cells = matrix(report)
    root = ElementTree.Element("testsuites", name=f"cobotwire conform {report.kind}")
    for case in case_ids(cells):
        suite = [cell for (_, other), cell in cells.items() if other == case]
        root.append(_suite(report, case, suite))
    if not report.finished:
        root.append(_unfinished(report))
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="utf-8"?>\n{text}\n'


def _suite(report: Report, case: str, cells: list[Cell]) -> ElementTree.Element:
    verdicts = [cell.verdict for cell in cells]
    suite = ElementTree.Element(
        "testsuite",
        name=printable(f"{report.edition}.{case}"),
        tests=str(len(cells)),
        failures=str(verdicts.count(Verdict.FAIL)),
        errors="0",
        skipped=str(sum(verdict in SKIPPED for verdict in verdicts)),
        timestamp=printable(report.started),
    )
    properties = ElementTree.SubElement(suite, "properties")
    for name in ("kind", "subject", "edition", "firmware", "untested"):
        value = printable(getattr(report, name))
        ElementTree.SubElement(properties, "property", name=name, value=value)
    for cell in cells:
        suite.append(_entry(report, cell))
    return suite


def _entry(report: Report, cell: Cell) -> ElementTree.Element:
    name = printable(cell.command or "the line")
    place = printable(f"{report.edition}.{cell.case}")
    entry = ElementTree.Element("testcase", classname=place, name=name)
    shown = cell.gravest
    if shown.verdict is Verdict.FAIL:
        failure = ElementTree.SubElement(entry, "failure", message=printable(shown.reason))
        failure.set("type", shown.outcome)
        failure.text = _in_full(report, shown)
    elif shown.verdict in SKIPPED:
        ElementTree.SubElement(entry, "skipped", message=printable(shown.reason))
    return entry


def _in_full(report: Report, result: Result) -> str:
    source = [f"required by {result.source}"] if result.source else []
    lines = [result.reason, *source, *evidence_lines(report.kind, result)]
    # XML cannot express control characters at all.
    return "\n".join(map(printable, lines))


def _unfinished(report: Report) -> ElementTree.Element:
    name = printable(f"{report.edition}.run")
    suite = ElementTree.Element(
        "testsuite", name=name, tests="1", failures="0", errors="1", skipped="0"
    )
    entry = ElementTree.SubElement(suite, "testcase", classname=name, name="run")
    message = "the run was interrupted"
    ElementTree.SubElement(entry, "error", message=message, type="interrupted")
    return suite
