"""``cobotwire conform statement``: write the template of a statement."""

from __future__ import annotations

import click

from cobotwire import editions
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.conformance.statement import statement_template


@click.command()
@uses_edition
def statement(edition: str) -> None:
    """Print the template of an implementation conformance statement (YAML) for an edition.

    A maker declares in it what a device has and lacks. `conform device --statement FILE` selects
    the test cases accordingly, and tests whether the statement is true:

    \b
      cobotwire conform statement --edition mycobot280 > statement.yaml
      cobotwire conform device URL --edition mycobot280 --statement statement.yaml
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    click.echo(statement_template(editions.load(edition).TABLE), nl=False)
