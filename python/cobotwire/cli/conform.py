"""``cobotwire conform``: test an arm, a client or a codec against the protocol."""

from __future__ import annotations

import click

from cobotwire.cli.shared.edition_option import edition_option
from cobotwire.cli.shared.lazy_group import LazyGroup

SUBCOMMANDS = {
    "device": "Test the arm at URL against an edition.",
    "client": "Serve an arm, and check the client that controls it.",
    "codec": "Test the codec that COMMAND runs against an edition.",
    "compare": "Compare two reports on the same subject.",
    "matrix": "Show several implementations side by side.",
    "verify": "Check the digest and the signature of a report or survey.",
    "cases": "List the test cases and the permissions.",
    "statement": "Write the template of a statement about a device.",
}


class _Conform(LazyGroup):
    subcommands = SUBCOMMANDS
    modules = "cobotwire.cli.conform_"


@click.group(cls=_Conform)
@edition_option
def conform() -> None:
    """Test an arm, a client or a codec against an edition of the protocol.

    Exit codes: 0 the subject conforms; 1 it does not; 2 it could not be tested.
    """
