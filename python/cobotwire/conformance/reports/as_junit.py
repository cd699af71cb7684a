"""Write reports as JUnit XML for build servers: one suite per test case, one entry per command."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element, indent, tostring

from cobotwire.conformance.hex_text import evidence_lines
from cobotwire.conformance.report import Report, Result, Verdict
from cobotwire.conformance.reports.element import element
from cobotwire.conformance.reports.grouped import columns, matrix, title_of
from cobotwire.protocol.printable import printable

SKIPPED = (Verdict.INCONCLUSIVE, Verdict.NOT_RUN)


def to_junit(report: Report) -> str:
    """Return a report as JUnit XML. What is inconclusive or was not run counts as skipped."""
    cells = matrix(report)
    suites = [
        _suite(report, case, [shown for (_, other), shown in cells.items() if other == case])
        for case in columns(cells)
    ]
    if not report.finished:
        name = f"{report.edition}.run"
        error = element("error", message="the run was interrupted", type="interrupted")
        entry = element("testcase", error, classname=name, name="run")
        counts = {"tests": 1, "failures": 0, "errors": 1, "skipped": 0}
        suites.append(element("testsuite", entry, name=name, **counts))
    root = element("testsuites", *suites, name=f"cobotwire conform {report.kind}")
    indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{tostring(root, encoding="unicode")}\n'


def _suite(report: Report, case: str, found: Sequence[Result]) -> Element:
    names = ("kind", "subject", "edition", "firmware", "untested")
    facts = (element("property", name=name, value=getattr(report, name)) for name in names)
    name = f"{report.edition}.{case}"
    entries = (
        element("testcase", *_outcome(report, each), classname=name, name=title_of(each.command))
        for each in found
    )
    return element(
        "testsuite",
        element("properties", *facts),
        *entries,
        name=name,
        tests=len(found),
        failures=sum(each.verdict is Verdict.FAIL for each in found),
        errors=0,
        skipped=sum(each.verdict in SKIPPED for each in found),
        timestamp=report.started,
    )


def _outcome(report: Report, shown: Result) -> Iterator[Element]:
    if shown.verdict is Verdict.FAIL:
        source = [f"required by {shown.source}"] if shown.source else []
        lines = [shown.explained, *source, *evidence_lines(report.kind, shown)]
        failure = element("failure", message=shown.reason, type=shown.outcome)
        # XML cannot express control characters at all.
        failure.text = "\n".join(map(printable, lines))
        yield failure
    elif shown.verdict in SKIPPED:
        yield element("skipped", message=shown.reason)
