"""Errors as exit codes that mean something."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

import click

from cobotwire.errors import (
    CaptureError,
    CobotwireError,
    LinkError,
    ProtocolError,
    ReplyTimeout,
    ScenarioError,
    UsageError,
)

CODES: tuple[tuple[type[CobotwireError], int], ...] = (
    (UsageError, 2),
    (ScenarioError, 2),
    (LinkError, 3),
    (ReplyTimeout, 4),
    (ProtocolError, 5),
    (CaptureError, 6),
)

EPILOG = (
    "Exit codes: 0 done; 1 the answer is no (a wrong answer, an illegal frame); 2 the call is "
    "wrong; 3 the link failed; 4 no reply; 5 an illegal reply; 6 a damaged recording; "
    "130 interrupted."
)


@contextmanager
def failures() -> Iterator[None]:
    """Turn cobotwire's errors into one line and an exit code."""
    try:
        yield
    except CobotwireError as error:
        click.echo(f"cobotwire: {error}", err=True)
        sys.exit(next((code for kind, code in CODES if isinstance(error, kind)), 1))
    except KeyboardInterrupt:
        sys.exit(130)
