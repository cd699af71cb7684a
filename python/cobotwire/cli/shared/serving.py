"""Serve a port until a signal ends it."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Sequence
from types import FrameType

import click

from cobotwire.cli.shared.exit_codes import note_signal
from cobotwire.cli.shared.output import print_line
from cobotwire.inspect.tap.forwarder import Forwarder
from cobotwire.simulator.server import Server


def serve(
    server: Server | Forwarder,
    first_line: str | None = None,
    between: Sequence[Callable[[], None]] = (),
) -> None:
    """Print the port (or ``first_line``), and serve it until Ctrl-C or SIGTERM.

    The functions in ``between`` are called from time to time, between two requests.
    """

    def stop(number: int, frame: FrameType | None) -> None:
        # If ending hangs, for example on a full output pipe, the next Ctrl-C kills the process.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        note_signal(number)

    # The wakeup descriptor ends the server, not the handler: Python runs handlers only after
    # select() has returned, and a signal just before select() does not make it return.
    signal.set_wakeup_fd(server.stopper)
    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    print_line(server.url if first_line is None else first_line)
    if sys.stdout.isatty():
        click.echo(f"Try: cobotwire call {server.url} get_angles   (Ctrl-C ends)", err=True)
    try:
        server.serve(between)
    finally:
        signal.set_wakeup_fd(-1)
        server.close()
