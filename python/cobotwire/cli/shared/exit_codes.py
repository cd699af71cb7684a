"""Turn cobotwire's errors into one line on standard error and an exit code; signals, too."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import click

from cobotwire.cli.shared.output import fold
from cobotwire.protocol.errors import (
    ArmNotReady,
    CaptureError,
    CobotwireError,
    LinkError,
    MotionTimeout,
    OutputError,
    ProtocolError,
    ReplyTimeout,
    ScenarioError,
    UsageError,
)

USAGE, LINK_FAILED, NO_REPLY, NOT_READY, NOT_WRITTEN, INTERRUPTED = 2, 3, 4, 7, 8, 130
# What a shell reports for a process that SIGPIPE or SIGTERM ended.
OUTPUT_CLOSED, TERMINATED = 141, 143

CODES: tuple[tuple[type[CobotwireError], int], ...] = (
    (UsageError, USAGE),
    (ScenarioError, USAGE),
    (LinkError, LINK_FAILED),
    (ReplyTimeout, NO_REPLY),
    (ProtocolError, 5),
    (CaptureError, 6),
    (ArmNotReady, NOT_READY),
    (MotionTimeout, NOT_READY),
    (OutputError, NOT_WRITTEN),
)

EPILOG = (
    "Exit codes: 0 success; 1 the result is negative (a wrong reply, an illegal frame); 2 wrong "
    "usage; 3 the port failed; 4 no reply; 5 an illegal reply; 6 a damaged recording; "
    "7 the arm does not obey a motion, or does not arrive; 8 a file cannot be written; "
    "130 interrupted; 143 terminated."
)


@contextmanager
def exit_on_errors() -> Iterator[None]:
    """Print an error of cobotwire, and exit with its code."""
    try:
        yield
    except CobotwireError as error:
        click.echo(fold(f"cobotwire: {error}", err=True), err=True)
        sys.exit(next((code for kind, code in CODES if isinstance(error, kind)), 1))
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)


_terminated = threading.Event()


def note_signal(number: int) -> None:
    """Remember a SIGTERM for the exit code; ignore further ones, since ``timeout`` sends two."""
    if number == signal.SIGTERM:
        signal.signal(number, signal.SIG_IGN)
        _terminated.set()


def _interrupt(number: int, frame: FrameType | None) -> None:
    note_signal(number)
    raise KeyboardInterrupt


@contextmanager
def sigterm_as_interrupt() -> Iterator[None]:
    """Handle SIGTERM in the block as Ctrl-C, but exit with its own code; in the main thread."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _terminated.clear()
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
        if _terminated.is_set():
            sys.exit(TERMINATED)
