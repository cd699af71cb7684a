"""``cobotwire capture merge``: write several recordings into one."""

from __future__ import annotations

import sys
from itertools import combinations

import click

from cobotwire.capture import editing
from cobotwire.cli.shared.capture_files import output_options, recorded_size, time_text
from cobotwire.cli.shared.progress_bar import progress_bar
from cobotwire.protocol.counted import counted
from cobotwire.protocol.printable import printable


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(), metavar="FILE...")
@output_options
def merge(files: tuple[str, ...], output: str, overwrite: bool) -> None:
    """Write the packets of the recordings FILE... into OUT, in the order of their times.

    Each interface of each FILE becomes an interface of OUT, with its own name and edition. The
    times do not change. Packets from different computers are in the right order only if the clocks
    of the computers agreed.

    \b
      cobotwire capture merge left.pcapng right.pcapng -o both.pcapng

    A warning names a port that two recordings contain at the same time. Recordings with several
    sections, and big-endian ones, are rejected.

    Exit codes: 0 success; 1 a FILE ends too early (OUT holds everything before that); 6 a FILE is
    damaged: repair it first.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    with progress_bar("merging", recorded_size(files)) as advance:
        found, lacks = editing.merge(files, output, overwrite=overwrite, progress=advance)
    click.echo(f"wrote {printable(output)}: {counted(len(found), 'interface')}", err=True)
    for number, each in enumerate(found):
        url = printable(each.interface.url) or "a port without a name"
        click.echo(f"  interface {number}: {url}, from {printable(each.source)}", err=True)
        click.echo(f"    {counted(each.packets, 'packet')}", err=True)
        if each.packets:
            click.echo(f"    from {time_text(each.first_ns)}", err=True)
            click.echo(f"    to   {time_text(each.last_ns)}", err=True)
    for one, other in combinations(found, 2):
        if one.overlaps(other):
            text = f"{one.source} and {other.source} overlap on {one.interface.url}"
            click.echo(f"cobotwire: {printable(text)}: the output may hold bytes twice", err=True)
    for lack in lacks:
        click.echo(f"cobotwire: {printable(lack)}", err=True)
    sys.exit(1 if lacks else 0)
