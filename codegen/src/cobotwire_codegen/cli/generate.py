"""``cobotwire-gen`` without a verb: this project's own files."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from cobotwire_codegen.cli.shared import problems_told, root_option
from cobotwire_codegen.emit import Target, compare, write
from cobotwire_codegen.project import editions, targets


@click.command()
@click.option("--check", "check_only", is_flag=True)
@root_option
def generate(check_only: bool, root: str) -> None:
    """Generate the editions, the command reference and the test data from spec/."""
    with problems_told():
        found = editions(Path(root))
    wanted = targets(Path(root), found)
    if check_only:
        sys.exit(show_stale(wanted))
    commands = ", ".join(f"{edition.name} ({len(edition.commands)} commands)" for edition in found)
    click.echo(f"{commands}: {write_all(wanted)} file(s) changed")


def write_all(wanted: list[Target]) -> int:
    """Write what is not fresh, and say so; gives the number of files."""
    changed = [path for target in wanted for path in write(target)]
    for path in changed:
        click.echo(f"{'wrote' if path.exists() else 'removed'} {path}")
    return len(changed)


def show_stale(wanted: list[Target]) -> int:
    """Show what is not fresh; gives the exit code."""
    stale = [item for target in wanted for item in compare(target)]
    for item in stale:
        click.echo(f"{item.kind}: {item.path}")
        if item.diff:
            click.echo(item.diff, nl=False)
    click.echo(f"{len(stale)} generated file(s) not fresh; run cobotwire-gen" if stale else "fresh")
    return 1 if stale else 0
