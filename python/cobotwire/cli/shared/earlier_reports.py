"""Read the report of an earlier run, to continue or repeat that run."""

from __future__ import annotations

from collections.abc import Mapping

from cobotwire.cli.shared.conform_report import text_of_file
from cobotwire.conformance import Report
from cobotwire.conformance.reports import from_json
from cobotwire.protocol.errors import UsageError


def read_report(argument: str, path: str) -> Report:
    """Return the report in a JSON file.

    Raises:
        UsageError: the file cannot be read, or is not a report.
    """
    return from_json(text_of_file(argument, path))


def earlier_report(
    resume: str | None, again: str | None, given: Mapping[str, object], edition: str, kind: str
) -> Report | None:
    """Return the report to continue or to repeat; None: neither is requested.

    Args:
        resume: the file of the report to continue.
        again: the file of the report to repeat.
        given: the other options that the caller gave, by name; the report has its own.
        edition: the edition of the run.
        kind: the kind of subject.

    Raises:
        UsageError: the file is no report on this kind of subject and this edition, or other
            options are given too.
    """
    if resume is None and again is None:
        return None
    name, path = ("--again", again) if resume is None else ("--resume", resume)
    if path is None or None not in (resume, again):
        raise UsageError("again", again, message="give either --resume or --again, not both")
    if given:
        names = ", ".join(f"--{each.replace('_', '-')}" for each in given)
        raise UsageError("options", message=f"{name} uses the options of the report: omit {names}")
    report = read_report(name.removeprefix("--"), path)
    if report.kind != kind:
        message = f"{path} is about a {report.kind}: use conform {report.kind}"
        raise UsageError("report", report.kind, message=message)
    if report.edition != edition:
        message = f"{path} is about the edition {report.edition}; add --edition {report.edition}"
        raise UsageError("edition", edition, message=message)
    return report
