"""``cobotwire conform compare``: what became of an arm, a client or a codec since then."""

from __future__ import annotations

import json
import sys
from collections import Counter
from dataclasses import asdict
from pathlib import Path

import click
from rich.console import Console
from rich.table import Table

from cobotwire.cli.conforming import CONFORMS, DOES_NOT, could_not_run
from cobotwire.conformance import Report
from cobotwire.conformance.reports import Comparison, from_json
from cobotwire.conformance.reports import compare as compared
from cobotwire.errors import UsageError

STYLES = {"worse": "red", "better": "green"}


@click.command()
@click.argument("before")
@click.argument("after")
@click.option("--json", "as_json", is_flag=True, help="Print what differs as JSON.")
def compare(before: str, after: str, as_json: bool) -> None:
    """Compare two reports that were written with --json.

    Exit codes: 0 nothing is worse; 1 something is: a test fails that did not, or passed and is not
    tested now; 2 a file is no report.
    """
    with could_not_run():
        found = compared(_read("before", before), _read("after", after))
    if as_json:
        click.echo(json.dumps(asdict(found), indent=1))
    else:
        _show(found)
    sys.exit(DOES_NOT if found.worse else CONFORMS)


def _read(argument: str, name: str) -> Report:
    try:
        text = Path(name).read_text(encoding="utf-8")
    except (OSError, UnicodeError) as error:
        raise UsageError(argument, name, f"a report in JSON ({error})") from error
    return from_json(text)


def _show(found: Comparison) -> None:
    console = Console(soft_wrap=True)
    table = Table("", "command", "rule", "before", "after", "what was found")
    for change in found.changes:
        verdicts = (change.before or "not there", change.after or "not there")
        row = (change.kind, change.command or "the line", change.rule, *verdicts, change.reason)
        table.add_row(*row, style=STYLES.get(change.kind))
    if found.changes:
        console.print(table)
    for slower in found.times:
        console.print(
            f"{slower.command}: median reply {1000 * slower.before:.1f} ms before,"
            f" {1000 * slower.after:.1f} ms after"
        )
    counts = Counter(change.kind for change in found.changes)
    told = ", ".join(f"{count} {kind}" for kind, count in counts.items())
    console.print(told or "No verdict differs.")
