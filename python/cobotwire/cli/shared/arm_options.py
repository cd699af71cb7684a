"""Open the port of an arm with the options of the subcommand, and record its traffic on request."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click

from cobotwire import codec as codecs
from cobotwire.capture import Recording
from cobotwire.cli.shared.output import report_written
from cobotwire.protocol.table import Table
from cobotwire.transport import OpenedTransport, TappedTransport, open_transport

Subcommand = Callable[..., Any]

baudrate_option = click.option(
    "--baudrate", type=int, help="Bits a second [default: the edition's]."
)
address_option = click.option(
    "--address", help="The device, by its name or number [default: the edition's first]."
)


def parse_address(text: str) -> int | str:
    """Return an address as clients take it: a number, or a name."""
    return int(text) if text.isascii() and text.isdigit() else text


def arm_options(subcommand: Subcommand) -> Subcommand:
    """Add the options of every subcommand that opens the port of an arm."""
    record_option = click.option(
        "--record", type=click.Path(), metavar="FILE", help="Record all traffic to FILE (pcapng)."
    )
    return baudrate_option(record_option(subcommand))


@contextmanager
def open_arm(
    port: str, table: Table, baudrate: int | None, record: str | None
) -> Iterator[OpenedTransport]:
    """Open a port; at the end close it and finish the recording, even after an error.

    Raises:
        UsageError: the port, the baud rate or the file is not allowed. Nothing was sent.
        LinkError: the port does not exist, or it cannot be opened.
        CaptureError: at the end: the recording is incomplete.
    """
    speed = table.baudrate if baudrate is None else baudrate
    transport = open_transport(port, speed)
    try:
        if record is None:
            yield transport
            return
        recording = Recording(record, codecs.load(table), url=port, baudrate=speed)
        try:
            yield TappedTransport(transport, recording.record)
        finally:
            recording.close()
            report_written(record)
    finally:
        transport.close()
