"""Handle SIGTERM as Ctrl-C is handled; only the exit code differs."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

# What a shell reports for a process that SIGTERM ended.
TERMINATED = 128 + signal.SIGTERM

_received = threading.Event()


def note_signal(number: int) -> None:
    """Remember a SIGTERM for the exit code; ignore further ones, since ``timeout`` sends two."""
    if number == signal.SIGTERM:
        signal.signal(number, signal.SIG_IGN)
        _received.set()


def _interrupt(number: int, frame: FrameType | None) -> None:
    note_signal(number)
    raise KeyboardInterrupt


@contextmanager
def sigterm_as_interrupt() -> Iterator[None]:
    """Raise KeyboardInterrupt in the block at SIGTERM; then exit with TERMINATED after it."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _received.clear()
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
        if _received.is_set():
            sys.exit(TERMINATED)
