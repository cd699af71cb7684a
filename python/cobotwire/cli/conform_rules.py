"""``cobotwire conform rules``: what is tested."""

from __future__ import annotations

import click

from cobotwire.conformance.device import CLASSES, RULES


@click.command()
def rules() -> None:
    """List the rules of the device tester, and what a run may be allowed to send."""
    for rule in RULES:
        click.echo(f"{rule.id:20} {rule.says}")
    click.echo("\nClasses of leave (--allow):")
    for name, says in CLASSES.items():
        click.echo(f"{name:20} {says}")
