"""What the verbs that test have in common: the summary, the report files, the exit code."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

import click

from cobotwire.conformance import Report, Verdict
from cobotwire.errors import CobotwireError

CONFORMS, DOES_NOT, COULD_NOT_RUN = 0, 1, 2


@contextmanager
def could_not_run() -> Iterator[None]:
    """Whatever goes wrong in here kept the test from running."""
    try:
        yield
    except CobotwireError as error:
        click.echo(f"cobotwire: {error}", err=True)
        sys.exit(COULD_NOT_RUN)


def conclude(report: Report) -> None:
    """Print what was found, and end with the exit code."""
    counts = Counter(result.verdict for result in report.results)
    for result in report.results:
        if result.verdict in (Verdict.FAIL, Verdict.UNSTABLE):
            click.echo(f"{result.verdict.upper():8} {result.rule:20} {result.command:24}")
            click.echo(f"         {result.reason}")
            for exchange in result.evidence:
                said = exchange.data[:64].hex(" ").upper()
                if report.kind == "codec":
                    said = exchange.data[:200].decode()
                click.echo(f"         {exchange.at:9.4f} {exchange.direction} {said}")
    told = ", ".join(f"{counts[verdict]} {verdict}" for verdict in Verdict if counts[verdict])
    click.echo(f"{report.subject}, edition {report.edition}: {told or 'nothing was tested'}")
    if not report.finished:
        click.echo("The run did not come to its end.")
        sys.exit(DOES_NOT if any(counts[v] for v in (Verdict.FAIL, Verdict.UNSTABLE)) else 2)
    sys.exit(CONFORMS if report.conforms else DOES_NOT)
