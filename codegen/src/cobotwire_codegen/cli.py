"""The command ``cobotwire-gen``."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from cobotwire_codegen.emit import Target, compare, write
from cobotwire_codegen.errors import SpecError
from cobotwire_codegen.project import editions, targets


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--check", is_flag=True, help="Write nothing; fail if a generated file is not fresh.")
@click.option(
    "--root",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    default=Path(),
    help="The project's folder, which holds spec/ [default: here].",
)
@click.version_option(package_name="cobotwire-codegen")
def main(check: bool, root: Path) -> None:
    """Generate the Python editions, the command reference and the test data from spec/.

    Exit code 0: all is fresh (or was written). 1: with --check, something on disk is stale, missing
    or left over; the diff says what. 2: the spec is wrong; each line names file, line and column.
    """
    try:
        found = editions(root)
    except SpecError as error:
        for problem in error.problems:
            click.echo(str(problem), err=True)
        click.echo(f"{len(error.problems)} problem(s) in the spec; nothing was written", err=True)
        sys.exit(2)
    if check:
        sys.exit(_check(targets(root, found)))
    changed = [path for target in targets(root, found) for path in write(target)]
    for path in changed:
        click.echo(f"{'wrote' if path.exists() else 'removed'} {path}")
    commands = ", ".join(f"{edition.name} ({len(edition.commands)} commands)" for edition in found)
    click.echo(f"{commands}: {len(changed)} file(s) changed")


def _check(wanted: list[Target]) -> int:
    stale = [item for target in wanted for item in compare(target)]
    for item in stale:
        click.echo(f"{item.kind}: {item.path}")
        if item.diff:
            click.echo(item.diff, nl=False)
    click.echo(f"{len(stale)} generated file(s) not fresh; run cobotwire-gen" if stale else "fresh")
    return 1 if stale else 0
