"""Turn errors of cobotwire into a line on standard error and an exit code; handle signals."""

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
# What a shell reports for a process that SIGPIPE ended.
OUTPUT_CLOSED = 141
# The signals that end a program gracefully, as Ctrl-C does. SIGHUP: its terminal is gone.
ENDING = [number for name in ("SIGTERM", "SIGHUP") if (number := getattr(signal, name, None))]

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
    "129 the terminal is gone; 130 interrupted; 143 terminated."
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


# The signal that ended the program.
_ended_by: list[int] = []


def note_signal(number: int) -> None:
    """Remember the signal that ends the program; ignore its repeats: ``timeout`` sends it twice."""
    if number in ENDING:
        signal.signal(number, signal.SIG_IGN)
        _ended_by.append(number)


def _interrupt(number: int, frame: FrameType | None) -> None:
    note_signal(number)
    raise KeyboardInterrupt


@contextmanager
def signals_as_interrupt() -> Iterator[None]:
    """Handle SIGTERM and SIGHUP in the block as Ctrl-C, but exit with their own codes.

    This applies only in the main thread. SIGHUP stays ignored where ``nohup`` started the program.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _ended_by.clear()
    taken = [number for number in ENDING if signal.getsignal(number) != signal.SIG_IGN]
    before = {number: signal.signal(number, _interrupt) for number in taken}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if _ended_by:
            sys.exit(128 + _ended_by[0])
