"""Refuse to work if the installed cobotwire has another version, since it runs generated code."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

import click


def check() -> None:
    """Compare the versions of the two distributions.

    cobotwire itself need not be installed: ``check``, ``diff`` and others work without it.

    Raises:
        UsageError: the installed cobotwire has another version.
    """
    ours = version("cobotwire-codegen")
    try:
        theirs = version("cobotwire")
    except PackageNotFoundError:
        return
    if ours != theirs:
        raise click.UsageError(
            f"cobotwire-codegen is {ours}, but the installed cobotwire is {theirs}. Generated "
            "packages need the same version of both: "
            "pip install --upgrade cobotwire cobotwire-codegen"
        )


def print_version(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    """Print the version, and exit; fail if the installed cobotwire has another version."""
    if wanted and not context.resilient_parsing:
        click.echo(f"cobotwire-gen {version('cobotwire-codegen')}")
        check()
        context.exit()
