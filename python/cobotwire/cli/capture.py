"""``cobotwire capture``: show what recordings hold; cut, merge and repair them."""

from __future__ import annotations

import click

from cobotwire.cli.shared.edition_option import edition_option
from cobotwire.cli.shared.lazy_group import LazyGroup

SUBCOMMANDS = {
    "info": "Show times, messages, rates, gaps and noise.",
    "cut": "Write part of a recording: a time range, some commands.",
    "merge": "Write several recordings into one, by time.",
    "repair": "Write what is whole in a damaged recording.",
}


class _Capture(LazyGroup):
    subcommands = SUBCOMMANDS
    modules = "cobotwire.cli.capture_"


@click.group(cls=_Capture)
@edition_option
def capture() -> None:
    """Show what recordings (pcapng) hold; cut, merge and repair them.

    Recordings that are compressed with gzip or zstd are read too. An input is never changed, and an
    output appears under its name only when it is complete.
    """
