"""``cobotwire run``: run a program that was written for the maker's library."""

from __future__ import annotations

import sys

import click

from cobotwire.pymycobot.running import run_program


@click.command(context_settings={"allow_interspersed_args": False})
@click.option(
    "--errors",
    type=click.Choice(["raise", "return"]),
    default="raise",
    show_default=True,
    help="What a call that fails does: raise an error, or return -1 as pymycobot does.",
)
@click.argument("script", type=click.Path())
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def run(errors: str, script: str, arguments: tuple[str, ...]) -> None:
    """Run the program SCRIPT as if cobotwire were the package pymycobot.

    The program is not changed, and neither is anything that is installed. ARGUMENTS are passed to
    it. When it ends, its arms are closed; if an error or Ctrl-C ends it, each arm is first sent
    `stop` once.

    The exit code is that of the program; 1 if an exception ended it.
    """
    sys.exit(run_program(script, arguments, "return" if errors == "return" else "raise"))
