"""Start and end the programs that a run tests, and say how they ended."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from typing import IO

from cobotwire.protocol.errors import LinkError

# How long a program may take to end after the first signal, in seconds.
ENDING = 2.0

# The number of characters of its last diagnostics that are shown.
SHOWN = 200


def start(
    command: Sequence[str], name: str, stdin: int, stdout: int, diagnostics: IO[bytes]
) -> subprocess.Popen[bytes]:
    """Start a program in a session of its own, with its standard error in a file.

    Raises:
        LinkError: it cannot be started; ``name`` is what the error calls it.
    """
    try:
        return subprocess.Popen(  # noqa: S603  (running the caller's command is the point)
            command,
            stdin=stdin,
            stdout=stdout,
            stderr=diagnostics,
            bufsize=0,
            start_new_session=True,
        )
    except OSError as error:
        raise LinkError(name, f"cannot be started: {error.strerror or error}") from error


def end(process: subprocess.Popen[bytes]) -> None:
    """End a program and the programs that it has started."""
    with suppress(OSError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, 15)
        else:
            process.terminate()
    try:
        process.wait(ENDING)
    except subprocess.TimeoutExpired:
        with suppress(OSError):
            os.killpg(process.pid, 9) if hasattr(os, "killpg") else process.kill()
        process.wait()


def ending(code: int, diagnostics: IO[bytes]) -> str:
    """Return how a program ended, with the last line that it wrote to its diagnostics.

    Args:
        code: its return code; below zero: the signal that killed it.
        diagnostics: the file that its standard error was written to.
    """
    how = f"it ended with code {code}"
    if code < 0:
        how = f"it was ended by {_signal(-code)}"
    diagnostics.seek(0)
    lines = diagnostics.read().decode(errors="replace").strip().splitlines()
    last = f"; its last diagnostics: {lines[-1][:SHOWN]}" if lines else ""
    return how + last


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
