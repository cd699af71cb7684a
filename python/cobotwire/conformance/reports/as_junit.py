"""Reports as JUnit XML, which build servers show: a suite a rule, a case a command."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from cobotwire.conformance.report import Report, Result, Verdict
from cobotwire.conformance.reports.evidence import lines_of
from cobotwire.conformance.reports.matrix import Cell, matrix, rules

# XML 1.0 has no way to write these.
UNSAYABLE = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
COMPLAINTS = {Verdict.FAIL: "failure", Verdict.UNSTABLE: "failure"}


def to_junit(report: Report) -> str:
    """A report as JUnit XML. What was not allowed or is not supported counts as skipped."""
    cells = matrix(report)
    root = ElementTree.Element("testsuites", name=f"cobotwire conform {report.kind}")
    for rule in rules(cells):
        suite = [cell for (_, other), cell in cells.items() if other == rule]
        root.append(_suite(report, rule, suite))
    if not report.finished:
        root.append(_unfinished(report))
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="utf-8"?>\n{text}\n'


def _suite(report: Report, rule: str, cells: list[Cell]) -> ElementTree.Element:
    verdicts = [cell.verdict for cell in cells]
    failed = sum(verdict in COMPLAINTS for verdict in verdicts)
    suite = ElementTree.Element(
        "testsuite",
        name=f"{report.edition}.{rule}",
        tests=str(len(cells)),
        failures=str(failed),
        errors="0",
        skipped=str(len(cells) - failed - verdicts.count(Verdict.PASS)),
        timestamp=report.began,
    )
    properties = ElementTree.SubElement(suite, "properties")
    for name in ("kind", "subject", "edition", "firmware"):
        value = _sayable(getattr(report, name))
        ElementTree.SubElement(properties, "property", name=name, value=value)
    for cell in cells:
        suite.append(_case(report, cell))
    return suite


def _case(report: Report, cell: Cell) -> ElementTree.Element:
    name = cell.command or "the line"
    case = ElementTree.Element("testcase", classname=f"{report.edition}.{cell.rule}", name=name)
    shown = next(result for result in cell.results if result.verdict is cell.verdict)
    if shown.verdict is Verdict.PASS:
        return case
    kind = COMPLAINTS.get(shown.verdict, "skipped")
    complaint = ElementTree.SubElement(case, kind, message=_sayable(shown.reason))
    if kind == "failure":
        complaint.set("type", shown.verdict.value)
        complaint.text = _sayable(_told(report, shown))
    return case


def _told(report: Report, result: Result) -> str:
    source = [f"the spec says so at {result.source}"] if result.source else []
    return "\n".join([result.reason, *source, *lines_of(report, result)])


def _unfinished(report: Report) -> ElementTree.Element:
    suite = ElementTree.Element(
        "testsuite", name=f"{report.edition}.run", tests="1", failures="0", errors="1", skipped="0"
    )
    case = ElementTree.SubElement(suite, "testcase", classname=f"{report.edition}.run", name="run")
    message = "the run did not come to its end"
    ElementTree.SubElement(case, "error", message=message, type="interrupted")
    return suite


def _sayable(text: str) -> str:
    return UNSAYABLE.sub("\ufffd", text)
