"""``cobotwire-gen schema``: write the JSON Schema for editors."""

from __future__ import annotations

import sys
from pathlib import Path, PurePosixPath

import click

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check as check_edition
from cobotwire_codegen.cli.generate import show_stale, write_all
from cobotwire_codegen.cli.shared import edition_path, report_problems, root_option
from cobotwire_codegen.emit import Target
from cobotwire_codegen.language.schema import schema_json
from cobotwire_codegen.project import editions, schema_target


@click.command()
@click.argument("files", nargs=-1)
@click.option(
    "--out", type=click.Path(dir_okay=False), help="The file to write; required with FILES."
)
@click.option("--check", "check_only", is_flag=True, help="Write nothing; fail if files are stale.")
@root_option
def schema(files: tuple[str, ...], out: str | None, check_only: bool, root: str) -> None:
    """Write spec/schema.json, the JSON Schema of the spec's files, or the schema of FILES.

    Editors with a YAML language server apply it to every file that starts with the line
    `# yaml-language-server: $schema=PATH/schema.json`. They then offer the names of the editions'
    types as completions.
    """
    if bool(files) != bool(out):
        raise click.UsageError(
            "give both FILES and --out; give neither to write the schema of spec/"
        )
    with report_problems():
        target = _own(files, Path(out)) if out else schema_target(Path(root), editions(Path(root)))
    if check_only:
        sys.exit(show_stale([target]))
    click.echo(f"{write_all([target])} file(s) changed")


def _own(files: tuple[str, ...], out: Path) -> Target:
    found = [build_edition(edition_path(file), Path.cwd()) for file in files]
    for edition in found:
        check_edition(edition)
    return Target(out.parent, {PurePosixPath(out.name): schema_json(found)}, alone=False)
