"""What the verbs that test have in common: the summary, the report files, the exit code."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial, wraps
from typing import Any

import click

from cobotwire.conformance import Report, Verdict
from cobotwire.conformance.reports import to_html, to_json, to_junit
from cobotwire.errors import CobotwireError, UsageError

CONFORMS, DOES_NOT, COULD_NOT_RUN = 0, 1, 2


@contextmanager
def could_not_run() -> Iterator[None]:
    """Whatever goes wrong in here kept the test from running."""
    try:
        yield
    except CobotwireError as error:
        click.echo(f"cobotwire: {error}", err=True)
        sys.exit(COULD_NOT_RUN)


@dataclass(frozen=True, slots=True)
class ReportFiles:
    """The files that a report is written to; ``-`` is standard output."""

    json: str | None = None
    html: str | None = None
    junit: str | None = None


NO_FILES = ReportFiles()
FORMS: dict[str, Callable[[Report], str]] = {"json": to_json, "html": to_html, "junit": to_junit}


def report_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """The options of every verb that reports; it gets them as ``files``."""

    @wraps(verb)
    def with_files(
        *words: Any, json: str | None, html: str | None, junit: str | None, **options: Any
    ) -> Any:
        return verb(*words, files=ReportFiles(json, html, junit), **options)

    help = {
        "--junit": "Write the report as JUnit XML, for build servers.",
        "--html": "Write the report as one HTML page: a matrix, and the evidence.",
        "--json": "Write the report as JSON, for programs and `conform compare`.",
    }
    found: Callable[..., Any] = with_files
    for name, text in help.items():
        found = click.option(name, metavar="FILE", help=f"{text} - prints it.")(found)
    return found


def write_reports(report: Report, files: ReportFiles) -> None:
    """Write the report in every form that was asked for.

    Raises:
        UsageError: a file cannot be written.
    """
    for form, text_of in FORMS.items():
        name = getattr(files, form)
        if name is None:
            continue
        try:
            with click.open_file(name, "w", encoding="utf-8") as file:
                file.write(text_of(report))
        except OSError as error:
            raise UsageError(form, name, f"a file that can be written ({error})") from error


def conclude(report: Report, files: ReportFiles = NO_FILES) -> None:
    """Write the reports, print what was found, and end with the exit code."""
    with could_not_run():
        write_reports(report, files)
    _summary(report, to_stderr="-" in (files.json, files.html, files.junit))
    if not report.finished:
        sys.exit(DOES_NOT if _bad(report) else COULD_NOT_RUN)
    sys.exit(CONFORMS if report.conforms else DOES_NOT)


def _bad(report: Report) -> bool:
    return any(result.verdict in (Verdict.FAIL, Verdict.UNSTABLE) for result in report.results)


def _summary(report: Report, to_stderr: bool) -> None:
    say = partial(click.echo, err=to_stderr)
    counts = Counter(result.verdict for result in report.results)
    for result in report.results:
        if result.verdict in (Verdict.FAIL, Verdict.UNSTABLE):
            say(f"{result.verdict.upper():8} {result.rule:20} {result.command:24}")
            say(f"         {result.reason}")
            for exchange in result.evidence:
                said = exchange.data[:64].hex(" ").upper()
                if report.kind == "codec":
                    said = exchange.data[:200].decode()
                say(f"         {exchange.at:9.4f} {exchange.direction} {said}")
    told = ", ".join(f"{counts[verdict]} {verdict}" for verdict in Verdict if counts[verdict])
    say(f"{report.subject}, edition {report.edition}: {told or 'nothing was tested'}")
    if not report.finished:
        say("The run did not come to its end.")
