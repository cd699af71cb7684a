"""``cobotwire-gen render``: a template of one's own, filled from an edition."""

from __future__ import annotations

from pathlib import Path

import click

from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check as check_edition
from cobotwire_codegen.cli.shared import (
    edition_path,
    format_option,
    problems_told,
    template_errors_told,
    unwritable_told,
)
from cobotwire_codegen.render import environment


@click.command()
@click.argument("template", type=click.Path(exists=True, dir_okay=False))
@click.argument("file")
@click.option("--out", type=click.Path(dir_okay=False), help="Write there instead of printing.")
@format_option
def render(template: str, file: str, out: str | None, form: str) -> None:
    """Fill the Jinja TEMPLATE from the edition FILE: a target of your own.

    The template sees the checked model as `edition`, and what our own templates see; it may include
    templates that stand beside it. docs/targets.md shows one.
    """
    path = Path(template)
    with problems_told(form):
        edition = build_edition(edition_path(file), Path.cwd())
        check_edition(edition)
    with template_errors_told(path.parent):
        text = environment(path.parent).get_template(path.name).render(edition=edition)
    if out is None:
        click.echo(text, nl=False)
        return
    with unwritable_told():
        Path(out).write_text(text, encoding="utf-8")
