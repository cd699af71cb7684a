"""Write a report as JSON, JUnit XML or HTML, read it back, and compare two reports."""

from cobotwire.conformance.reports.as_html import to_html
from cobotwire.conformance.reports.as_json import document_of, from_json, report_digest, to_json
from cobotwire.conformance.reports.as_junit import to_junit
from cobotwire.conformance.reports.compare import Change, Comparison, compare
from cobotwire.conformance.reports.side_by_side import Row, counts, side_by_side

__all__ = [
    "Change",
    "Comparison",
    "Row",
    "compare",
    "counts",
    "document_of",
    "from_json",
    "report_digest",
    "side_by_side",
    "to_html",
    "to_json",
    "to_junit",
]
