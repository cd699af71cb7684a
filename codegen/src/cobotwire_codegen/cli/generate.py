"""``cobotwire-gen`` without a verb: generate this project's own files."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from cobotwire_codegen.cli.shared import report_problems, root_option
from cobotwire_codegen.emit import Target, compare, write
from cobotwire_codegen.project import PRODUCTS, RUST_DATA, committed, editions, products
from cobotwire_codegen.suite_pages import SuiteError, suite_pages


@click.command()
@click.option("--check", "check_only", is_flag=True)
@click.option("--products", "with_products", is_flag=True)
@click.option("--rust-data", is_flag=True)
@root_option
def generate(check_only: bool, with_products: bool, rust_data: bool, root: str) -> None:
    """Generate what is committed: editions, reference, the decoder's tables, the spec's schema.

    With --products, also generate what is not committed: output targets, data of the Rust tests.
    With --rust-data, generate only the latter.
    """
    if rust_data and with_products:
        raise click.UsageError("--products includes the data of --rust-data: give one of them")
    with report_problems():
        found = editions(Path(root))
        wanted = [] if rust_data else committed(Path(root), found)
    if with_products or rust_data:
        wanted += products(Path(root), found, [RUST_DATA] if rust_data else PRODUCTS)
    if check_only:
        sys.exit(show_stale(wanted + ([] if rust_data else _suite(Path(root)))))
    changed = write_all(wanted)
    if not rust_data:
        # After the editions, because it lists their commands.
        changed += write_all(_suite(Path(root)))
    commands = ", ".join(f"{edition.name} ({len(edition.commands)} commands)" for edition in found)
    click.echo(f"{commands}: {changed} file(s) changed")


def _suite(root: Path) -> list[Target]:
    """Return the pages of the test suite, or exit with 1."""
    try:
        return suite_pages(root)
    except SuiteError as error:
        click.echo(f"cobotwire-gen: {error}", err=True)
        sys.exit(1)


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
