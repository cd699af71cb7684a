"""``cobotwire conform rules``: what is tested."""

from __future__ import annotations

import json

import click

from cobotwire.conformance.client.rules import RULES as OF_CLIENTS
from cobotwire.conformance.codec.judge import RULES as OF_CODECS
from cobotwire.conformance.device import CLASSES
from cobotwire.conformance.device import RULES as OF_DEVICES

RULES: dict[str, dict[str, str]] = {
    "device": {rule.id: rule.says for rule in OF_DEVICES},
    "client": {rule.id: rule.what for rule in OF_CLIENTS},
    "codec": OF_CODECS,
}


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object.")
def rules(as_json: bool) -> None:
    """List the rules of each tester, and what a run on a device may be allowed to send."""
    if as_json:
        click.echo(json.dumps({"rules": RULES, "classes": CLASSES}, indent=1))
        return
    for kind, found in RULES.items():
        _list(f"conform {kind}:", found)
    _list("conform device --allow:", CLASSES)


def _list(title: str, lines: dict[str, str]) -> None:
    click.echo(title)
    for name, says in lines.items():
        click.echo(f"  {name:20} {says}")
