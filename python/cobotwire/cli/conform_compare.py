"""``cobotwire conform compare``: compare two reports on the same subject."""

from __future__ import annotations

import json
import sys
from collections import Counter
from dataclasses import asdict

import click
from rich.console import Console
from rich.table import Table
from rich.text import Text

from cobotwire.cli.shared.conform_report import CONFORMS, DOES_NOT, exit_if_not_testable
from cobotwire.cli.shared.earlier_reports import read_report
from cobotwire.conformance.reports import Comparison
from cobotwire.conformance.reports import compare as compared
from cobotwire.protocol.printable import printable

STYLES = {"worse": "red", "better": "green"}


@click.command()
@click.argument("before", type=click.Path())
@click.argument("after", type=click.Path())
@click.option("--json", "as_json", is_flag=True, help="Print the differences as JSON.")
def compare(before: str, after: str, as_json: bool) -> None:
    """Compare the reports BEFORE and AFTER, which were written with --json.

    Exit codes: 0 nothing is worse; 1 something is worse: a test case fails that did not fail
    before, or one that passed does not pass now; 2 a file is not a report.
    """
    with exit_if_not_testable():
        found = compared(read_report("before", before), read_report("after", after))
    if as_json:
        click.echo(json.dumps(asdict(found), indent=1))
    else:
        _show(found)
    sys.exit(DOES_NOT if found.worse else CONFORMS)


def _show(found: Comparison) -> None:
    console = Console(soft_wrap=True)
    table = Table("", "command", "test case", "before", "after", "what was found")
    for change in found.changes:
        outcomes = (change.before or "no result", change.after or "no result")
        row = (change.kind, change.command or "(transport)", change.case, *outcomes, change.reason)
        # As plain text, because what a report quotes may look like markup.
        table.add_row(*(Text(printable(part)) for part in row), style=STYLES.get(change.kind))
    if found.changes:
        console.print(table)
    for slower in found.times:
        times = f"{1000 * slower.before:.1f} ms before, {1000 * slower.after:.1f} ms after"
        console.print(Text(f"{printable(slower.command)}: median reply {times}"))
    counts = Counter(change.kind for change in found.changes)
    summary = ", ".join(f"{count} {kind}" for kind, count in counts.items())
    console.print(summary or "No verdict differs.")
