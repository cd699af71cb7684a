"""Write a report as JSON, JUnit XML or HTML, read it back, and compare two reports."""

from cobotwire.conformance.reports.as_html import to_html
from cobotwire.conformance.reports.as_json import document_of, from_json, report_digest, to_json
from cobotwire.conformance.reports.as_junit import to_junit
from cobotwire.conformance.reports.compare import Change, Comparison, compare

__all__ = [
    "Change",
    "Comparison",
    "compare",
    "document_of",
    "from_json",
    "report_digest",
    "to_html",
    "to_json",
    "to_junit",
]
