"""``cobotwire-gen`` without a subcommand: generate this project's own files."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

import click

from cobotwire_codegen.cli.shared import report_problems, root_option
from cobotwire_codegen.emit import Target, compare, write
from cobotwire_codegen.project import (
    PRODUCTS,
    RUST_EDITIONS,
    committed,
    editions,
    products,
    schema_target,
)
from cobotwire_codegen.suite_pages import SuiteError


@click.command()
@click.option("--check", "check_only", is_flag=True)
@click.option("--products", "with_products", is_flag=True)
@click.option("--rust-data", is_flag=True)
@root_option
def generate(check_only: bool, with_products: bool, rust_data: bool, root: str) -> None:
    """Generate the committed files (editions and their reference), and the schema for editors.

    With --products, also generate the files that are not committed: the other pages of the docs
    site, output targets, the editions of the Rust client. With --rust-data, generate only the
    editions of the Rust client.
    """
    if rust_data and with_products:
        raise click.UsageError("--products includes the data of --rust-data: give one of them")
    path = Path(root)
    with report_problems():
        found = editions(path)
        wanted = [] if rust_data else committed(path, found)
    changed = 0 if check_only else write_all(wanted)
    all_or_none: Iterable[str] = PRODUCTS if with_products else ()
    folders = [RUST_EDITIONS] if rust_data else all_or_none
    try:
        # After the editions, because the pages of the test suite list their commands.
        others = products(path, found, folders)
    except SuiteError as error:
        raise click.ClickException(str(error)) from error
    if check_only:
        sys.exit(show_stale(wanted + others))
    changed += write_all(others if rust_data else [schema_target(path, found), *others])
    commands = ", ".join(f"{edition.name} ({len(edition.commands)} commands)" for edition in found)
    click.echo(f"{commands}: {changed} file(s) changed")


def write_all(wanted: list[Target]) -> int:
    """Write the files that are stale, print their names, and return their number."""
    changed = [path for target in wanted for path in write(target)]
    for path in changed:
        click.echo(f"{'wrote' if path.exists() else 'removed'} {path}")
    return len(changed)


def show_stale(wanted: list[Target]) -> int:
    """Print the files that are stale, and return the exit code."""
    stale = [item for target in wanted for item in compare(target)]
    for item in stale:
        click.echo(f"{item.kind}: {item.path}")
        if item.diff:
            click.echo(item.diff, nl=False)
    click.echo(f"{len(stale)} generated file(s) are stale; run cobotwire-gen" if stale else "fresh")
    return 1 if stale else 0
