"""Say how a program ended that a run has started."""

from __future__ import annotations

import signal
from typing import IO

# The characters of its last diagnostics that are shown.
SHOWN = 200


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
