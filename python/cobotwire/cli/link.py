"""The link of a verb that talks to an arm, recorded where ``--record`` asks for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click

from cobotwire import codec as codecs
from cobotwire.capture import Recording
from cobotwire.table import Table
from cobotwire.transport import Link, TappedLink, open_link

Decorated = Callable[..., Any]


def link_options(verb: Decorated) -> Decorated:
    """The options of every verb that opens a link, in their order."""
    for option in (
        click.option(
            "--record", metavar="FILE", help="Write all that goes over the line to FILE (pcapng)."
        ),
        click.option("--baudrate", type=int, help="Bits a second [default: the edition's]."),
    ):
        verb = option(verb)
    return verb


@contextmanager
def linked(port: str, table: Table, baudrate: int | None, record: str | None) -> Iterator[Link]:
    """The open link; closed at the end, and the recording ended in order, whatever happened.

    Raises:
        UsageError: the port, the baud rate or the file is not allowed. No byte was sent.
        LinkError: the port is not there, or cannot be opened.
        CaptureError: at the end: the recording ends early.
    """
    speed = table.baudrate if baudrate is None else baudrate
    link = open_link(port, speed)
    try:
        if record is None:
            yield link
            return
        with Recording(record, codecs.load(table), url=port, baudrate=speed) as recording:
            yield TappedLink(link, recording.record)
    finally:
        link.close()
