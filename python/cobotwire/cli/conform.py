"""``cobotwire conform``: does this arm, this client, this codec keep to the protocol?"""

from __future__ import annotations

import click

from cobotwire.cli.conform_client import client
from cobotwire.cli.conform_codec import codec
from cobotwire.cli.conform_compare import compare
from cobotwire.cli.conform_device import device
from cobotwire.cli.conform_rules import rules


@click.group()
def conform() -> None:
    """Test an arm, a client or a codec against an edition of the protocol.

    Exit codes: 0 it conforms; 1 it does not; 2 it could not be tested.
    """


for verb in (device, client, codec, compare, rules):
    conform.add_command(verb)
