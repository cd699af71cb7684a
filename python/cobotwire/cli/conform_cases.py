"""``cobotwire conform cases``: list the test cases."""

from __future__ import annotations

import json

import click

from cobotwire.conformance.catalogue import NUMBERS, VERSION
from cobotwire.conformance.client import SUITE as CLIENTS
from cobotwire.conformance.codec import SUITE as CODECS
from cobotwire.conformance.device import PERMISSIONS
from cobotwire.conformance.device import SUITE as DEVICES

CASES: dict[str, dict[str, str]] = {
    "device": {case.id: case.purpose for case in DEVICES.cases},
    "client": {case.id: case.purpose for case in CLIENTS.cases},
    "codec": {case.id: case.purpose for case in CODECS.cases},
}


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object.")
def cases(as_json: bool) -> None:
    """List the test cases for each subject, and the permissions for a run on a device."""
    if as_json:
        listed = {
            "catalogue": VERSION,
            "cases": CASES,
            "clauses": NUMBERS,
            "permissions": PERMISSIONS,
        }
        click.echo(json.dumps(listed, indent=1))
        return
    click.echo(f"catalogue version {VERSION}")
    for kind, found in CASES.items():
        _list(f"conform {kind}:", found)
    _list("conform device --allow:", PERMISSIONS)


def _list(title: str, lines: dict[str, str]) -> None:
    click.echo(title)
    for name, text in lines.items():
        click.echo(f"{NUMBERS.get(name, ''):>4}  {name:22} {text}")
