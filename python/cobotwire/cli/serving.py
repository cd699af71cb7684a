"""What the verbs that serve a port have in common: an end by signals, output that may be cut."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Sequence
from types import FrameType

import click

from cobotwire.sim.server import Server


def serve(
    server: Server, first_line: str | None = None, looks: Sequence[Callable[[], None]] = ()
) -> None:
    """Print the port, or the line that tells it, and serve it until Ctrl-C or SIGTERM.

    ``looks`` are called now and then, between two requests.
    """

    def stop(number: int, frame: FrameType | None) -> None:
        # Should the end hang, on a full pipe behind our output for one, the next signal ends it.
        signal.signal(number, signal.SIG_DFL)

    # Not by the handler: Python calls that only when select() has returned, and a signal that comes
    # a moment before does not end it.
    signal.set_wakeup_fd(server.stopper)
    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    say(server.url if first_line is None else first_line)
    if sys.stdout.isatty():
        click.echo(f"Try: cobotwire call get_angles --port {server.url}   (Ctrl-C ends)", err=True)
    try:
        server.serve(looks)
    finally:
        signal.set_wakeup_fd(-1)
        server.close()


def say(line: str) -> None:
    """Print a line, for as long as there is somebody who reads it."""
    try:
        click.echo(line)
    except BrokenPipeError:
        # Whoever read our output (head -1, say) has had enough; the arm goes on serving. The
        # descriptor is replaced, so that nothing printed later, nor the flush at exit, fails.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
