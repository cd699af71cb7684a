"""A process at the other end of a pseudo-terminal, and the verdict on a measured figure."""

from __future__ import annotations

import os
import subprocess
import sys
import tty
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def responder(script: str, *arguments: str) -> Iterator[str]:
    """Run a Python script on one end of a new pty; yield the name of the other end.

    The script gets the file descriptor of its end as its first argument.
    """
    master, slave = os.openpty()
    tty.setraw(slave)
    command = [sys.executable, "-c", script, str(master), *arguments]
    with subprocess.Popen(command, pass_fds=[master]) as process:
        try:
            yield os.ttyname(slave)
        finally:
            process.kill()
            os.close(master)
            os.close(slave)


def within(met: bool) -> str:
    """Return the word that a bench prints before a limit."""
    return "within" if met else "OVER"
