"""``cobotwire-gen build``: generate a Python package from a protocol of your own."""

from __future__ import annotations

import keyword
import sys
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import click

from cobotwire_codegen.check import checked_edition
from cobotwire_codegen.cli.generate import show_stale, write_all
from cobotwire_codegen.cli.shared import (
    check_names,
    edition_path,
    format_option,
    report_problems,
    report_template_errors,
    report_write_errors,
)
from cobotwire_codegen.emit import Target, foreign
from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import Files, render_python, render_reference
from cobotwire_codegen.targets.c import render_c
from cobotwire_codegen.targets.rust import render_rust
from cobotwire_codegen.targets.typescript import render_typescript
from cobotwire_codegen.targets.vectors import render_shared_vectors
from cobotwire_codegen.targets.wireshark import render_wireshark

# What is generated into the folder of each option.
RENDERERS: dict[str, Callable[[Edition, Path | None], Files]] = {
    "--out": render_python,
    "--docs": render_reference,
    "--c": render_c,
    "--rust": render_rust,
    "--typescript": render_typescript,
    "--wireshark": lambda edition, own: render_wireshark([edition], own),
    "--vectors": lambda edition, own: render_shared_vectors([edition]),
}
# These folders may contain other files: Wireshark's has other plugins, and JSON files carry no mark
# that shows whether they were generated.
SHARED = ("--wireshark", "--vectors")


@click.command()
@click.argument("file")
@click.option(
    "--out", required=True, type=click.Path(file_okay=False), help="The folder of the package."
)
@click.option(
    "--docs", type=click.Path(file_okay=False), help="Also write the reference, to this folder."
)
@click.option("--c", type=click.Path(file_okay=False), help="Also write C code, to this folder.")
@click.option(
    "--rust",
    type=click.Path(file_okay=False),
    help="Also write a module for the crate cobotwire, to this folder.",
)
@click.option(
    "--typescript",
    type=click.Path(file_okay=False),
    help="Also write a module for the npm package cobotwire, to this folder.",
)
@click.option(
    "--wireshark",
    type=click.Path(file_okay=False),
    help="Also write a Wireshark dissector, to this folder; it may contain other files.",
)
@click.option(
    "--vectors",
    type=click.Path(file_okay=False),
    help="Also write vectors in JSON, to this folder; it may contain other files.",
)
@click.option(
    "--templates",
    type=click.Path(exists=True, file_okay=False),
    help="Templates of your own; each replaces the built-in one of the same name. Templates are "
    "code: they decide what the package does when it is imported. Use only those that you trust.",
)
@click.option("--check", "check_only", is_flag=True, help="Write nothing; fail if files are stale.")
@format_option
def build(
    file: str,
    out: str,
    docs: str | None,
    c: str | None,
    rust: str | None,
    typescript: str | None,
    wireshark: str | None,
    vectors: str | None,
    templates: str | None,
    check_only: bool,
    format: str,
) -> None:
    """Generate a typed Python package from the edition FILE.

    The package works with the installed cobotwire: its codecs, client, simulator and command line
    (`cobotwire --edition PACKAGE`). The folders of package and reference must contain nothing else.
    """
    path = edition_path(file)
    given = {
        "--out": out,
        "--docs": docs,
        "--c": c,
        "--rust": rust,
        "--typescript": typescript,
        "--wireshark": wireshark,
        "--vectors": vectors,
    }
    folders = {option: Path(folder) for option, folder in given.items() if folder}
    _check_folders(folders)
    with report_problems(format):
        edition = checked_edition(path, Path.cwd())
    own = Path(templates) if templates else None
    check_names(own)
    with report_problems(format), report_template_errors(own):
        wanted = [
            Target(folder, RENDERERS[option](edition, own), alone=option not in SHARED)
            for option, folder in folders.items()
        ]
    if check_only:
        sys.exit(show_stale(wanted))
    strangers = [path for target in wanted for path in foreign(target)]
    if strangers:
        shown = ", ".join(str(path) for path in strangers[:3])
        raise click.UsageError(
            f"the folder contains files that were not generated: {shown}; choose another folder"
        )
    with report_write_errors():
        written = write_all(wanted)
    click.echo(f"{edition.name} ({len(edition.commands)} commands): {written} file(s)")


def _check_folders(folders: dict[str, Path]) -> None:
    """Raise an error if the package's name is not importable, or if folders are nested."""
    name = folders["--out"].resolve().name
    if not name.isidentifier() or keyword.iskeyword(name) or name == "cobotwire":
        raise click.UsageError(f"{name} is not a valid package name; choose another folder")
    for first, second in combinations(folders, 2):
        one, other = folders[first].resolve(), folders[second].resolve()
        if one == other or one in other.parents or other in one.parents:
            raise click.UsageError(f"{first} and {second} must be separate folders")
