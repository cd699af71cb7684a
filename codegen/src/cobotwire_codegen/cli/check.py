"""``cobotwire-gen check``: report the problems of a spec."""

from __future__ import annotations

from pathlib import Path

import click

from cobotwire_codegen.check import checked_edition
from cobotwire_codegen.cli.shared import edition_path, format_option, report_problems, root_option
from cobotwire_codegen.errors import Problem, SpecError
from cobotwire_codegen.project import spec_files


@click.command()
@click.argument("files", nargs=-1)
@root_option
@format_option
def check(files: tuple[str, ...], root: str, format: str) -> None:
    """Check the edition FILES, or all of spec/, and report every problem at once.

    A problem is `file:line:column: code: message`. Codes are stable; `cobotwire-gen explain CODE`
    explains a code.
    """
    problems: list[Problem] = []
    with report_problems(format):
        paths = [edition_path(file) for file in files] or spec_files(Path(root))
        for path in paths:
            try:
                checked_edition(path, Path(root))
            except SpecError as error:
                problems.extend(error.problems)
        if problems:
            raise SpecError(problems)
    if format == "json":
        click.echo("[]")
    elif format == "text":
        click.echo(f"{len(paths)} edition(s), no problems")
