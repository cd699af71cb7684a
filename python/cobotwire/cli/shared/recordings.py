"""Open recordings, and warn if they are incomplete."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from cobotwire.protocol.errors import EmptyInput

if TYPE_CHECKING:
    from cobotwire.capture import CaptureReader, Direction

ARROWS: dict[Direction, str] = {"sent": ">", "received": "<", "unknown": "?"}

interface_option = click.option(
    "--interface",
    type=int,
    help="The index of the interface, if the recording has several.",
)


def notify(text: str) -> None:
    """Print a sentence about the input to standard error."""
    click.echo(f"cobotwire: {text}", err=True)


def open_recording(path: str) -> CaptureReader:
    """Open a recording, or what another program recorded; say how the latter is read."""
    # Imported here, because hex arguments do not need it.
    from cobotwire.capture import read

    capture = read(path)
    if capture.foreign:
        notify(capture.foreign.notice)
    return capture


def seconds_column(after: float | None) -> str:
    """Return the seconds since the start of a recording for a line; blanks if it has no times."""
    return " " * 10 if after is None else f"{after:10.6f}"


def warn_if_incomplete(capture: CaptureReader) -> bool:
    """Print to standard error what a user should know about a recording that was read.

    Return whether it is incomplete.

    Raises:
        EmptyInput: it holds no packet.
    """
    for note in capture.foreign.file.notes if capture.foreign else ():
        notify(note)
    if not capture.packets and capture.truncated_at is None:
        raise EmptyInput(capture.name)
    if capture.incomplete:
        notify(capture.incomplete)
    return bool(capture.incomplete)
