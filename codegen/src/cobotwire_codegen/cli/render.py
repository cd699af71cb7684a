"""``cobotwire-gen render``: fill a template of your own from an edition."""

from __future__ import annotations

from pathlib import Path

import click

from cobotwire_codegen.check import checked_edition
from cobotwire_codegen.cli.shared import (
    edition_path,
    format_option,
    report_problems,
    report_template_errors,
    report_write_errors,
)
from cobotwire_codegen.render import environment


@click.command()
@click.argument("template", type=click.Path(exists=True, dir_okay=False))
@click.argument("file")
@click.option(
    "--out", type=click.Path(dir_okay=False), help="Write to this file instead of printing."
)
@format_option
def render(template: str, file: str, out: str | None, format: str) -> None:
    """Fill the Jinja TEMPLATE from the edition FILE, to make a target of your own.

    The template can use the checked model as `edition`, and all names of the built-in templates. It
    may include templates in its folder. docs/targets.md shows an example.
    """
    path = Path(template)
    with report_problems(format):
        edition = checked_edition(edition_path(file), Path.cwd())
    with report_template_errors(path.parent):
        text = environment(path.parent).get_template(path.name).render(edition=edition)
    if out is None:
        click.echo(text, nl=False)
        return
    with report_write_errors():
        Path(out).write_text(text, encoding="utf-8")
