"""``cobotwire capture repair``: write what is whole in a recording."""

from __future__ import annotations

import sys

import click

from cobotwire.capture import editing
from cobotwire.cli.shared.capture_files import output_options, recorded_size
from cobotwire.cli.shared.progress_bar import progress_bar
from cobotwire.protocol.counted import counted
from cobotwire.protocol.printable import printable


@click.command()
@click.argument("file", type=click.Path(), metavar="FILE")
@output_options
def repair(file: str, output: str, overwrite: bool) -> None:
    """Write everything that is whole in the recording FILE to OUT, and mark OUT as finished.

    The report says which bytes of FILE (after decompression) are lost, and why. If FILE is whole
    already, OUT is a copy.

    \b
      cobotwire capture repair killed.pcapng -o whole.pcapng

    Exit codes: 0 nothing is lost; 1 the report names what is lost; 6 FILE does not begin as a
    recording, so nothing of it can be used.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    with progress_bar("repairing", recorded_size([file])) as advance:
        done = editing.repair(file, output, overwrite=overwrite, progress=advance)
    if not done.lost_ranges and not done.marked:
        click.echo(f"{printable(file)} is whole: {printable(output)} is a copy", err=True)
        return
    click.echo(f"wrote {printable(output)}: {counted(done.packets, 'packet')}", err=True)
    if done.marked:
        click.echo(f"  {counted(done.marked, 'interface')} marked as finished", err=True)
    if done.lost_ranges:
        places = counted(done.lost_ranges, "place")
        click.echo(f"  {counted(done.lost_bytes, 'byte')} lost in {places}:", err=True)
    for begin, end, why in done.losses:
        click.echo(f"    at byte {begin}, {counted(end - begin, 'byte')}: {why}", err=True)
    if done.lost_ranges > len(done.losses):
        click.echo("    and others", err=True)
    sys.exit(1 if done.lost_ranges else 0)
