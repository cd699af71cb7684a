"""The option ``--edition``, which is given before the subcommand or after it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import click

from cobotwire.cli.shared.completers import complete_editions
from cobotwire.editions import DEFAULT

# The key of the given editions in ``meta``, which the contexts of groups and subcommand share.
_GIVEN = "cobotwire.editions"


def _choose(context: click.Context, option: click.Parameter, names: Sequence[str]) -> None:
    given: list[str] = context.meta.setdefault(_GIVEN, [])
    given += names
    if len(set(given)) > 1:
        message = f"--edition is given twice: {given[0]} and {given[-1]}"
        raise click.UsageError(message, context)
    context.obj = given[0] if given else DEFAULT


edition_option = click.option(
    "--edition",
    multiple=True,
    expose_value=False,
    callback=_choose,
    metavar="NAME",
    shell_complete=complete_editions,
    help="The protocol edition of the arm, or a package (name or folder) built by cobotwire-gen"
    f" [default: {DEFAULT}].",
)


def uses_edition(subcommand: Callable[..., Any]) -> Callable[..., Any]:
    """Give a subcommand the option, and the edition as its first argument."""
    return edition_option(click.pass_obj(subcommand))


def note_unused(context: click.Context, subcommand: click.Command) -> None:
    """Print to standard error that the edition before a subcommand has no effect on it."""
    takes = isinstance(subcommand, click.Group) or any(
        "--edition" in p.opts for p in subcommand.params
    )
    if context.meta.get(_GIVEN) and not takes:
        click.echo(f"cobotwire: {subcommand.name} does not use --edition", err=True)
