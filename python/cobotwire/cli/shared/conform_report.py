"""Conclude a conformance run: print the summary, write the reports, choose the exit code."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial, wraps
from typing import Any

import click

from cobotwire.capture.file_errors import unusable_file
from cobotwire.cli.shared.output import fold, report_written
from cobotwire.conformance import Report
from cobotwire.conformance.hex_text import exchanged
from cobotwire.conformance.reports import to_html, to_json, to_junit
from cobotwire.protocol.errors import CobotwireError
from cobotwire.protocol.printable import printable

CONFORMS, DOES_NOT, NOT_TESTABLE = 0, 1, 2
# The first characters of an exchange that are printed: 67 bytes in hex.
SHOWN = 200


@contextmanager
def exit_if_not_testable() -> Iterator[None]:
    """Exit with ``NOT_TESTABLE`` if an error prevents the test."""
    try:
        yield
    except CobotwireError as error:
        click.echo(f"cobotwire: {error}", err=True)
        sys.exit(NOT_TESTABLE)


@dataclass(frozen=True, slots=True)
class ReportFiles:
    """The names of the files for the report; ``-`` is standard output."""

    json: str | None = None
    html: str | None = None
    junit: str | None = None


NO_FILES = ReportFiles()
FORMATS: dict[str, Callable[[Report], str]] = {"json": to_json, "html": to_html, "junit": to_junit}


def report_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options for report files; the verb gets them as ``files``."""

    @wraps(verb)
    def with_files(
        *words: Any, json: str | None, html: str | None, junit: str | None, **options: Any
    ) -> Any:
        return verb(*words, files=ReportFiles(json, html, junit), **options)

    help = {
        "--junit": "Write the report as JUnit XML, for build servers",
        "--html": "Write the report as an HTML page with a matrix and the evidence",
        "--json": "Write the report as JSON, for programs and `conform compare`",
    }
    found: Callable[..., Any] = with_files
    for name, text in help.items():
        if name == "--json":
            # As in every other verb, --json alone prints JSON.
            json_option = click.option(
                name,
                type=click.Path(),
                is_flag=False,
                flag_value="-",
                metavar="[FILE]",
                help=f"{text} (or print it).",
            )
            found = json_option(found)
            continue
        found = click.option(
            name, type=click.Path(), metavar="FILE", help=f"{text} (-: standard output)."
        )(found)
    return found


def write_reports(report: Report, files: ReportFiles) -> None:
    """Write the report in every requested format.

    Raises:
        UsageError: a file cannot be written.
    """
    for format, text_of in FORMATS.items():
        name = getattr(files, format)
        if name is None:
            continue
        try:
            with click.open_file(name, "w", encoding="utf-8") as file:
                file.write(text_of(report))
        except OSError as error:
            raise unusable_file(format, name, error) from error
        if name != "-":
            report_written(name)


def conclude(report: Report, files: ReportFiles = NO_FILES) -> None:
    """Write the reports, print the failures and counts, and exit with the verdict's code."""
    with exit_if_not_testable():
        write_reports(report, files)
    _print_summary(report, to_stderr="-" in (files.json, files.html, files.junit))
    if not report.finished:
        sys.exit(DOES_NOT if report.failures else NOT_TESTABLE)
    sys.exit(CONFORMS if report.conforms else DOES_NOT)


def _print_summary(report: Report, to_stderr: bool) -> None:
    echo = partial(click.echo, err=to_stderr)
    for result in report.failures:
        echo(f"{result.outcome.upper():8} {result.case:20} {result.command:24}")
        echo(f"         {printable(result.reason)}")
        for also in result.further:
            echo(f"         also, {printable(also)}")
        for exchange in result.evidence:
            data = printable(exchanged(report.kind, exchange)[:SHOWN])
            echo(fold(f"         {exchange.at:9.4f} {exchange.direction} {data}", err=to_stderr))
    counts = Counter(result.outcome for result in report.results)
    summary = ", ".join(f"{count} {outcome}" for outcome, count in counts.items())
    echo(
        f"{printable(report.subject)}, edition {report.edition}: {summary or 'nothing was tested'}"
    )
    if report.untested:
        echo(printable(report.untested))
    if not report.finished:
        why = f": {printable(report.stopped)}" if report.stopped else ""
        echo(f"The run is incomplete{why}.")
