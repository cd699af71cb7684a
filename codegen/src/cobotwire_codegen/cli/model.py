"""``cobotwire-gen model``: print the model as JSON, for generators in any language."""

from __future__ import annotations

from pathlib import Path

import click

from cobotwire_codegen.check import checked_edition
from cobotwire_codegen.cli.shared import (
    edition_path,
    format_option,
    report_problems,
    report_write_errors,
)
from cobotwire_codegen.publish import edition_json


@click.command()
@click.argument("file")
@click.option(
    "--out", type=click.Path(dir_okay=False), help="Write to this file instead of printing."
)
@format_option
def model(file: str, out: str | None, format: str) -> None:
    """Publish the checked model of the edition FILE as versioned JSON.

    References are resolved, defaults filled in and deltas applied.
    """
    with report_problems(format):
        edition = checked_edition(edition_path(file), Path.cwd())
    text = edition_json(edition, complete=True)
    if out is None:
        click.echo(text, nl=False)
    else:
        with report_write_errors():
            Path(out).write_text(text, encoding="utf-8")
