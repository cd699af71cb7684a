"""``cobotwire conform verify``: check the digest and the signature of a report or survey."""

from __future__ import annotations

import json
import sys
from zipfile import is_zipfile

import click

from cobotwire.cli.shared.conform_report import (
    CONFORMS,
    DOES_NOT,
    exit_if_not_testable,
    text_of_file,
)
from cobotwire.conformance.reports import document_of
from cobotwire.conformance.survey.file import unsealed
from cobotwire.inspect.seal import Seal, check_seal, load_public_key
from cobotwire.protocol.printable import printable


@click.command()
@click.argument("report", type=click.Path())
@click.option(
    "--key", type=click.Path(), help="The public key that must have signed the report (Ed25519)."
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object.")
def verify(report: str, key: str | None, as_json: bool) -> None:
    """Check whether REPORT (JSON, or a survey) was changed, and show who signed it.

    A valid signature shows that the owner of the printed key signed the report. To check that this
    owner is the tester, pass --key with the public key that the tester gave you.

    Exit codes: 0 the report was not changed, and with --key, that key signed it; 1 otherwise;
    2 the file is not a report.
    """
    with exit_if_not_testable():
        wanted = None if key is None else load_public_key(key)
        survey = is_zipfile(report)
        document = unsealed(report)[0] if survey else document_of(text_of_file("report", report))
        seal = check_seal(document)
    mistake = _mistake(seal, wanted)
    if as_json:
        found = {"right": not mistake, "mistake": mistake, **seal._asdict()}
        click.echo(json.dumps(found, indent=1))
    else:
        signed = f"signed with the key {seal.key}" if seal.key else "not signed"
        click.echo(mistake or f"{printable(report)} was not changed; it is {signed}.")
    sys.exit(DOES_NOT if mistake else CONFORMS)


def _mistake(seal: Seal, wanted: str | None) -> str:
    """Return what is wrong with a report; empty: nothing."""
    if not seal.stated:
        return "The report has no digest, so changes cannot be detected."
    if seal.digest != seal.stated:
        return f"The report was changed: its digest is {seal.digest}, not {printable(seal.stated)}."
    if seal.signature == "wrong":
        return "The signature is wrong: it belongs to another report or to another key."
    if wanted is not None and not seal.key:
        return "The report is not signed."
    if wanted is not None and seal.key != wanted:
        return f"The report is signed with another key: {seal.key}."
    return ""
