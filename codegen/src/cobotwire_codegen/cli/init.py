"""``cobotwire-gen init``: start a protocol of your own."""

from __future__ import annotations

import re
from pathlib import Path

import click

from cobotwire_codegen.author.start import first_protocol
from cobotwire_codegen.cli.shared import report_problems

_NAME = re.compile(r"[a-z][a-z0-9_]*\Z")


@click.command()
@click.argument("name")
@click.option("--out", type=click.Path(dir_okay=False), help="The file. Default: NAME.yaml.")
def init(name: str, out: str | None) -> None:
    """Start a protocol called NAME: write one commented YAML file, and its schema for editors.

    `check` and `build` accept the file as it is. Existing files are not overwritten.
    """
    if not _NAME.match(name):
        raise click.UsageError(f"{name} is not a valid package name; write it like my_device")
    path = Path(out or f"{name}.yaml")
    schema = path.with_suffix(".schema.json")
    there = [str(file) for file in (path, schema) if file.exists()]
    if there:
        raise click.UsageError(f"{' and '.join(there)} already exists; choose another --out")
    if not path.parent.is_dir():
        raise click.UsageError(f"there is no folder {path.parent}")
    with report_problems():
        texts = first_protocol(name, schema.name)
    for file, text in zip((path, schema), texts):
        file.write_text(text, encoding="utf-8")
        click.echo(f"wrote {file}")
    click.echo(f"Next: cobotwire-gen build {path} --out {name}")
