"""``cobotwire conform``: test an arm, a client or a codec against the protocol."""

from __future__ import annotations

import click

from cobotwire.cli.conform_cases import cases
from cobotwire.cli.conform_client import client
from cobotwire.cli.conform_codec import codec
from cobotwire.cli.conform_compare import compare
from cobotwire.cli.conform_device import device
from cobotwire.cli.conform_statement import statement


@click.group(short_help="Test an arm, a client or a codec.")
def conform() -> None:
    """Test an arm, a client or a codec against an edition of the protocol.

    Exit codes: 0 the subject conforms; 1 it does not; 2 it could not be tested.
    """


for verb in (device, client, codec, compare, cases, statement):
    conform.add_command(verb)
