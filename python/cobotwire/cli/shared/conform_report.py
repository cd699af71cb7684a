"""Conclude a conformance run: print the summary, write the reports, choose the exit code."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial, wraps
from pathlib import Path
from typing import Any

import click

from cobotwire.capture.file_errors import unusable_file
from cobotwire.cli.shared.output import fold, report_written
from cobotwire.conformance import Report
from cobotwire.conformance.expected import Expectation, with_known
from cobotwire.conformance.hex_text import exchanged
from cobotwire.conformance.host import HostWatch, clock_mistake
from cobotwire.conformance.privacy import anonymous, hashed
from cobotwire.conformance.reports import to_html, to_json, to_junit
from cobotwire.inspect.seal import Signer, load_signer
from cobotwire.protocol.errors import CobotwireError, UsageError
from cobotwire.protocol.printable import printable

CONFORMS, DOES_NOT, NOT_TESTABLE = 0, 1, 2
# How many characters of an exchange are printed: 67 bytes in hex.
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
class ReportOptions:
    """The caller's options for the report, and the facts about the run that it states.

    ``json``, ``html`` and ``junit`` are names of files; ``-`` is standard output. ``expected`` is
    the text of the file of known failures. ``watch`` observes the host from the start of the
    subcommand.
    """

    json: str | None = None
    html: str | None = None
    junit: str | None = None
    tester: str = ""
    serial: str = ""
    signer: Signer | None = None
    expected: str = ""
    expected_name: str = ""
    watch: HostWatch = field(default_factory=HostWatch)


def report_options(subcommand: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options for reports; the subcommand gets them as ``wanted``."""

    @wraps(subcommand)
    def with_report(
        *words: Any,
        json: str | None,
        html: str | None,
        junit: str | None,
        tester: str,
        serial: str,
        sign: str | None,
        expected: str | None,
        **options: Any,
    ) -> Any:
        with exit_if_not_testable():
            if sign is not None and json is None:
                raise UsageError("sign", sign, message="--sign needs --json")
            signer = None if sign is None else load_signer(sign)
            known = "" if expected is None else text_of_file("expected", expected)
        wanted = ReportOptions(json, html, junit, tester, serial, signer, known, expected or "")
        return subcommand(*words, wanted=wanted, **options)

    details = {
        "--sign": "With --json: sign the report with this private key (Ed25519).",
        "--serial": "The serial number of the subject; the report has a hash of it.",
        "--tester": "Who is responsible for the run.",
        "--expected": "Known failures: a name and a reason per line.",
    }
    files = ("--sign", "--expected")
    found: Callable[..., Any] = with_report
    for name, text in details.items():
        found = click.option(
            name,
            type=click.Path() if name in files else str,
            metavar={"--sign": "KEY", "--expected": "FILE"}.get(name, "TEXT"),
            default=None if name in files else "",
            help=text,
        )(found)
    help = {
        "--junit": "Write the report as JUnit XML, for build servers",
        "--html": "Write the report as an HTML page with a matrix and the evidence",
        "--json": "Write the report as JSON, for programs and `conform compare`",
    }
    for name, text in help.items():
        if name == "--json":
            # As in every other subcommand, --json alone prints JSON.
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


def text_of_file(argument: str, path: str) -> str:
    """Return the text of a file.

    Raises:
        UsageError: it cannot be read.
    """
    try:
        return Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeError) as error:
        raise unusable_file(argument, path, error) from error


def write_reports(report: Report, wanted: ReportOptions) -> None:
    """Write the report in every requested format.

    Raises:
        UsageError: a file cannot be written.
    """
    formats: dict[str, Callable[[Report], str]] = {
        "json": partial(to_json, sign=wanted.signer),
        "html": to_html,
        "junit": to_junit,
    }
    for format, text_of in formats.items():
        name = getattr(wanted, format)
        if name is None:
            continue
        try:
            with click.open_file(name, "w", encoding="utf-8") as file:
                file.write(text_of(report))
        except OSError as error:
            raise unusable_file(format, name, error) from error
        if name != "-":
            report_written(name)


def conclude(report: Report, wanted: ReportOptions, known: Sequence[Expectation] = ()) -> None:
    """Write the reports, print the failures and counts, and exit with the verdict's code.

    ``known`` are the expected failures; empty if the run has already taken them into account.
    """
    report.results = with_known(known, report.results)
    report.tester, report.serial = wanted.tester, hashed(wanted.serial)
    report.host = wanted.watch.host()
    report = anonymous(report)
    with exit_if_not_testable():
        write_reports(report, wanted)
    _print_summary(report, to_stderr="-" in (wanted.json, wanted.html, wanted.junit))
    if not report.finished:
        sys.exit(DOES_NOT if report.failures else NOT_TESTABLE)
    sys.exit(CONFORMS if report.conforms else DOES_NOT)


def _print_summary(report: Report, to_stderr: bool) -> None:
    echo = partial(click.echo, err=to_stderr)
    for result in report.failures:
        echo(f"{result.outcome.upper():8} {result.case:20} {result.command:24}")
        echo(f"         {printable(result.explained)}")
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
    if mistake := clock_mistake(report.host):
        echo(mistake)
    if not report.finished:
        why = f": {printable(report.stopped)}" if report.stopped else ""
        echo(f"The run is incomplete{why}.")
