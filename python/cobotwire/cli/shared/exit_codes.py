"""Turn cobotwire's errors into one line on standard error and an exit code."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

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

LINK_FAILED, NO_REPLY, NOT_READY, NOT_WRITTEN, INTERRUPTED = 3, 4, 7, 8, 130
# What a shell reports for a process that SIGPIPE ended.
OUTPUT_CLOSED = 141

CODES: tuple[tuple[type[CobotwireError], int], ...] = (
    (UsageError, 2),
    (ScenarioError, 2),
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
