"""What the subcommands of ``cobotwire capture`` share: options, sizes, and the texts of times."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from typing import Any

import click

from cobotwire.capture.export.inputs import COMPRESSED

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def output_options(subcommand: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options of a subcommand that writes a recording."""
    subcommand = click.option("--overwrite", is_flag=True, help="Replace OUT if it exists.")(
        subcommand
    )
    help = "The recording to write."
    option = click.option("-o", "--output", required=True, metavar="OUT", help=help)
    return option(subcommand)


def recorded_size(paths: Iterable[str]) -> int | None:
    """Return the size of all recordings in bytes; None if one must be decompressed to know it."""
    total = 0
    for path in paths:
        if not os.path.isfile(path) or path.endswith((*COMPRESSED,)):
            return None
        total += os.path.getsize(path)
    return total


def time_text(time_ns: int) -> str:
    """Return a time in UTC, and in the time zone of this computer."""
    # The range of local times differs between systems.
    with suppress(OverflowError, OSError, ValueError):
        time = _EPOCH + timedelta(microseconds=time_ns // 1000)
        return f"{time:%Y-%m-%d %H:%M:%S.%f} UTC (here: {time.astimezone():%H:%M:%S %z})"
    return f"{time_ns} ns after 1970"
