"""Assembles the subcommands."""

from __future__ import annotations

import click

from cobotwire_codegen.cli import same_version
from cobotwire_codegen.cli.build import build
from cobotwire_codegen.cli.check import check
from cobotwire_codegen.cli.diff import diff
from cobotwire_codegen.cli.evidence import evidence
from cobotwire_codegen.cli.explain import explain
from cobotwire_codegen.cli.generate import generate
from cobotwire_codegen.cli.ids import ids
from cobotwire_codegen.cli.init import init
from cobotwire_codegen.cli.lsp import lsp
from cobotwire_codegen.cli.model import model
from cobotwire_codegen.cli.new_command import new_command
from cobotwire_codegen.cli.reconcile import reconcile
from cobotwire_codegen.cli.render import render
from cobotwire_codegen.cli.schema import schema
from cobotwire_codegen.cli.shared import root_option
from cobotwire_codegen.cli.vectors import vectors
from cobotwire_codegen.cli.watch import watch

_EPILOG = (
    "Exit codes: 0 success; 1 something is stale or differs; 2 the spec or the command line is "
    "wrong."
)


@click.group(
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=_EPILOG,
)
@click.option("--check", "check_only", is_flag=True, help="Write nothing; fail if files are stale.")
@click.option(
    "--products", "with_products", is_flag=True, help="Also generate files that are not committed."
)
@click.option(
    "--rust-data", is_flag=True, help="Generate only the editions of this project's Rust client."
)
@root_option
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=same_version.print_version,
    help="Show the version; fail if the installed cobotwire has another version.",
)
@click.pass_context
def main(
    ctx: click.Context, check_only: bool, with_products: bool, rust_data: bool, root: str
) -> None:
    """Generate software from a protocol in YAML.

    Without a subcommand, generate the files of this project (editions, reference, schema) from
    spec/. With --check, report files that are stale, missing or left over instead.
    """
    same_version.check()
    if ctx.invoked_subcommand is None:
        chosen = {"check_only": check_only, "with_products": with_products, "rust_data": rust_data}
        ctx.invoke(generate, **chosen, root=root)


SUBCOMMANDS = (
    build,
    render,
    check,
    model,
    explain,
    init,
    schema,
    diff,
    new_command,
    ids,
    vectors,
    reconcile,
    evidence,
    watch,
    lsp,
)
for subcommand in SUBCOMMANDS:
    main.add_command(subcommand)
