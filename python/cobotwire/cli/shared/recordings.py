"""Open recordings, and warn if they are incomplete."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import closing
from typing import TYPE_CHECKING

import click

from cobotwire.capture.byte_source import hex_arguments
from cobotwire.protocol.errors import CobotwireError

if TYPE_CHECKING:
    from cobotwire.capture import CaptureReader, Direction

ARROWS: dict[Direction, str] = {"sent": ">", "received": "<", "unknown": "?"}

interface_option = click.option(
    "--interface",
    type=int,
    default=0,
    show_default=True,
    help="The index of the interface, if the recording has several.",
)


def recording_named(arguments: Sequence[str]) -> CaptureReader | None:
    """Return the recording that the single argument names; None if it is something else."""
    # Hex is not looked up as a file name, and a pipe is not read, which would consume its start.
    single = len(arguments) == 1 and hex_arguments(arguments) is None
    if not single or not os.path.isfile(arguments[0]):
        return None
    # Imported here, because bytes in hex need nothing of it.
    from cobotwire.capture import is_capture, read
    from cobotwire.capture.capture_file import open_capture

    try:
        with closing(open_capture(arguments[0])) as file:
            first = file.read(12)
    except (OSError, CobotwireError):
        return None
    return read(arguments[0]) if is_capture(first) else None


def warn_if_incomplete(capture: CaptureReader) -> None:
    """Print to standard error what is missing at the end of a recording."""
    if capture.incomplete:
        click.echo(f"cobotwire: {capture.incomplete}", err=True)
