"""``cobotwire capture cut``: write a part of a recording."""

from __future__ import annotations

import re
import sys
from decimal import Decimal
from typing import Literal

import click

from cobotwire.capture import editing, read
from cobotwire.capture.export.plan import check_commands
from cobotwire.capture.export.times import time_ns
from cobotwire.cli.shared.capture_files import output_options, recorded_size
from cobotwire.cli.shared.completers import complete_commands
from cobotwire.cli.shared.edition_option import uses_edition
from cobotwire.cli.shared.progress_bar import progress_bar
from cobotwire.inspect.captured import recorded_codecs
from cobotwire.inspect.exporting import InstalledEditions
from cobotwire.protocol.counted import counted
from cobotwire.protocol.errors import UsageError
from cobotwire.protocol.printable import printable

_SECONDS = re.compile(r"[0-9]{1,12}(\.[0-9]{1,9})?")


def _names(context: click.Context, option: click.Parameter, value: str | None) -> tuple[str, ...]:
    return tuple(value.split(",")) if value else ()


@click.command()
@click.argument("file", type=click.Path(), metavar="FILE")
@output_options
@click.option("--from", "begin", metavar="TIME", help="Keep packets from this time on.")
@click.option("--to", "end", metavar="TIME", help="Keep packets before this time.")
@click.option(
    "--commands",
    callback=_names,
    metavar="NAMES",
    shell_complete=complete_commands,
    help="Keep only these requests and their replies: names with commas between them.",
)
@click.option(
    "--not-commands",
    callback=_names,
    metavar="NAMES",
    shell_complete=complete_commands,
    help="Leave these requests and their replies out.",
)
@click.option(
    "--noise",
    type=click.Choice(["keep", "drop"]),
    help="What to do with noise; by default it is dropped if commands are chosen, else kept.",
)
@uses_edition
def cut(
    edition: str,
    file: str,
    output: str,
    begin: str | None,
    end: str | None,
    commands: tuple[str, ...],
    not_commands: tuple[str, ...],
    noise: Literal["keep", "drop"] | None,
    overwrite: bool,
) -> None:
    """Write the chosen packets of the recording FILE to OUT.

    A TIME is in seconds from the first packet, as decode prints them, or in ISO 8601 (UTC, unless
    it names a time zone). The bytes, times and comments of what is kept do not change, and all
    interfaces stay.

    Noise is bytes that belong to no frame. If it is kept while frames are left out, parts of it may
    join, and look like a frame.

    \b
      cobotwire capture cut arm.pcapng -o part.pcapng --from 12.5 --to 60
      cobotwire capture cut arm.pcapng -o part.pcapng --from 2026-11-23T14:00
      cobotwire capture cut arm.pcapng -o angles.pcapng --commands get_angles,send_angles

    Exit codes: 0 success; 1 FILE ends too early (OUT holds everything before that), or no packet
    was chosen; 6 FILE is damaged: repair it first.
    """  # noqa: D301  (click keeps the lines of a paragraph that starts with the character \b)
    check_commands((*commands, *not_commands), InstalledEditions(edition))
    by_command = bool(commands or not_commands)
    if not by_command and (begin, end, noise) == (None, None, None):
        message = "cut needs a choice: --from, --to, --commands, --not-commands or --noise"
        raise UsageError("from", message=message)
    choose = None
    if by_command or noise == "drop":
        codecs, kept_noise = recorded_codecs(edition), noise == "keep"
        choose = editing.by_command(codecs, commands, not_commands, kept_noise)
    ends = _time(begin, "--from", file), _time(end, "--to", file)
    with progress_bar("cutting", recorded_size([file])) as advance:
        counts, lacks = editing.cut(
            file, output, *ends, choose, overwrite=overwrite, progress=advance
        )
    kept = counts.pop("kept", 0)
    click.echo(f"wrote {printable(output)}: {counted(kept, 'packet')}", err=True)
    for why, count in counts.items():
        click.echo(f"  {counted(count, 'packet')} left out: {why}", err=True)
    if lacks:
        click.echo(f"cobotwire: {printable(file)}: {lacks}", err=True)
    if not kept:
        click.echo(f"cobotwire: nothing of {printable(file)} was chosen", err=True)
    sys.exit(1 if lacks or not kept else 0)


def _time(text: str | None, option: str, file: str) -> int | None:
    """Return the time that an option names, in nanoseconds since 1970 (UTC)."""
    if text is None:
        return None
    if _SECONDS.fullmatch(text):
        with read(file) as capture:
            start_ns = next((packet.time_ns for packet in capture), 0)
        return start_ns + int(Decimal(text) * 10**9)
    try:
        return time_ns(text, option)
    except UsageError as error:
        message = f"{error}, or seconds from the first packet, such as 12.5"
        raise UsageError(option, text, message=message) from None
