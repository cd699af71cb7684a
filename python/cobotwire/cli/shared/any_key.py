"""Interrupt the main thread when any key is pressed, as Ctrl-C does."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

if sys.platform == "win32":
    import _thread
    import msvcrt
else:
    import select
    import signal
    import termios
    import tty

# How often, in seconds, the thread checks whether the block has ended.
POLL = 0.1


@contextmanager
def interrupted_by_any_key(wanted: bool = True) -> Iterator[None]:
    """Raise KeyboardInterrupt in the block when a key is pressed; only on a terminal.

    ``wanted`` is False for a block that only Ctrl-C interrupts.
    """
    if not wanted or not sys.stdin.isatty():
        yield
        return
    ended = threading.Event()
    watch = _watch_windows if sys.platform == "win32" else _watch
    thread = threading.Thread(target=watch, args=(ended,), daemon=True)
    with _single_keys():
        thread.start()
        try:
            yield
        finally:
            ended.set()
            thread.join()


@contextmanager
def _single_keys() -> Iterator[None]:
    """Deliver each key without waiting for the end of a line; restore the terminal at the end."""
    if sys.platform == "win32":
        yield
        return
    descriptor = sys.stdin.fileno()
    before = termios.tcgetattr(descriptor)
    tty.setcbreak(descriptor)
    try:
        yield
    finally:
        termios.tcsetattr(descriptor, termios.TCSAFLUSH, before)


def _watch(ended: threading.Event) -> None:
    if sys.platform != "win32":
        while not ended.is_set():
            if select.select([sys.stdin], [], [], POLL)[0]:
                # Only a signal to the main thread itself ends its wait for the arm.
                signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
                return


def _watch_windows(ended: threading.Event) -> None:
    if sys.platform == "win32":
        while not ended.wait(POLL):
            if msvcrt.kbhit():
                _thread.interrupt_main()
                return
