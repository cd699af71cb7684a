"""``cobotwire-gen vectors``: propose the vectors that an edition lacks."""

from __future__ import annotations

import sys

import click

from cobotwire_codegen.author.append import appended
from cobotwire_codegen.author.place import vectors_file
from cobotwire_codegen.author.propose import proposed
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.cli.shared import (
    DEFAULT_EDITION,
    edition_path,
    report_problems,
    report_write_errors,
)


@click.command()
@click.argument("file", default=DEFAULT_EDITION)
@click.option("--write", is_flag=True, help="Add the proposed vectors to the edition's files.")
def vectors(file: str, write: bool) -> None:
    """Propose a vector for each variant of a message that no vector of FILE shows.

    The frames are computed from values that would show a mistake, such as another byte order.
    Compare each one with a capture, a document or another library before it counts as evidence.
    Vectors of the base that a delta inherits need no proposal.

    Exit codes: 0 nothing is missing, or the proposals were written; 1 vectors are missing; 2 the
    spec or the command line is wrong.
    """
    path = edition_path(file)
    with report_problems(), report_write_errors():
        entries = list(proposed(build_edition(path, path.parent)))
        home = vectors_file(path)
        if write and entries:
            text = home.read_text(encoding="utf-8")
            for lines in entries:
                text = appended(text, str(home), "vectors", lines, False)
            home.write_text(text, encoding="utf-8")
            what = f"{len(entries)} computed vectors added"
            click.echo(f"{home}: {what}; they prove nothing until compared with real frames")
            return
    for lines in entries:
        click.echo("\n".join(lines))
    if entries:
        click.echo(f"{len(entries)} vectors are missing; --write adds them to {home}", err=True)
        sys.exit(1)
    click.echo("every variant has a vector", err=True)
