"""``cobotwire conform matrix``: show the reports of several implementations side by side."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from string import ascii_uppercase

import click
from rich.console import Console
from rich.table import Table
from rich.text import Text

from cobotwire.cli.shared.conform_report import CONFORMS, DOES_NOT, exit_if_not_testable
from cobotwire.cli.shared.earlier_reports import read_report
from cobotwire.conformance import Report
from cobotwire.conformance.reports import Row, counts, side_by_side
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.printable import printable

FACTS = ("subject", "edition", "firmware", "tester", "started", "conforms")


@click.command()
@click.argument("reports", nargs=-1, type=click.Path())
@click.option("--json", "as_json", is_flag=True, help="Print all rows as JSON.")
def matrix(reports: tuple[str, ...], as_json: bool) -> None:
    """Show REPORTS, which were written with --json, side by side.

    Each column is one report. Compare, for example, several arms, firmwares, clients or codecs. The
    first table counts the verdicts of each test case; the second one lists the verdicts that
    differ.

    Exit codes: 0 all subjects conform; 1 one does not; 2 a file is not a report.
    """
    with exit_if_not_testable():
        if not 2 <= len(reports) <= len(ascii_uppercase):
            message = f"{len(reports)} reports are given; needed: 2 to {len(ascii_uppercase)}"
            raise UsageError("REPORTS", len(reports), message=message)
        found = [read_report("report", path) for path in reports]
        rows = side_by_side(found)
    if as_json:
        heads = [{fact: getattr(report, fact) for fact in FACTS} for report in found]
        click.echo(
            json.dumps({"reports": heads, "rows": [row._asdict() for row in rows]}, indent=1)
        )
    else:
        _show(found, rows)
    sys.exit(CONFORMS if all(report.conforms for report in found) else DOES_NOT)


def _show(reports: Sequence[Report], rows: Sequence[Row]) -> None:
    console = Console(soft_wrap=False)
    letters = ascii_uppercase[: len(reports)]
    for letter, report in zip(letters, reports):
        firmware = f", firmware {report.firmware}" if report.firmware else ""
        tester = f", {report.tester}" if report.tester else ""
        about = f"{letter}  {report.subject}, edition {report.edition}{firmware}{tester}"
        console.print(Text(printable(about)))
    cases = dict.fromkeys((row.clause, row.case) for row in rows)
    table = _table("clause", "test case", *letters)
    for clause, case in cases:
        own = [row for row in rows if row.case == case]
        cells = [counts(own, index) for index in range(len(reports))]
        table.add_row(str(clause or ""), Text(printable(case)), *cells)
    console.print(table)
    differing = [row for row in rows if row.differs]
    if not differing:
        console.print("No verdict differs.")
        return
    console.print("Verdicts that differ:")
    table = _table("test case", "command", *letters)
    for row in differing:
        names = (row.case, row.command or "(transport)", *(each or "-" for each in row.outcomes))
        table.add_row(*(Text(printable(name)) for name in names))
    console.print(table)


def _table(*names: str) -> Table:
    """Return a table whose first two columns do not wrap."""
    table = Table()
    for index, name in enumerate(names):
        table.add_column(name, no_wrap=index < 2)
    return table
