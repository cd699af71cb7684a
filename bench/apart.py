"""Call a function in a separate process, and end it after a time limit, since it may hang.

The processes are forked from one that has already imported what they need, so that imports are not
timed.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from typing import Any, NamedTuple

_PROCESSES = multiprocessing.get_context("forkserver")


class Started(NamedTuple):
    """A process that will send the result of its function."""

    process: multiprocessing.context.ForkServerProcess
    end: Connection

    def result(self, until: float) -> Any:
        """Return the result, or None if it has not arrived by ``until`` (``time.monotonic()``)."""
        result = None
        if self.end.poll(max(0.0, until - time.monotonic())):
            result = self.end.recv()
            self.process.join(1)
        self.process.kill()
        self.process.join()
        return result


def warm_up(modules: Sequence[str]) -> None:
    """Start the process from which the others are forked, and import these modules there."""
    _PROCESSES.set_forkserver_preload(list(modules))
    first = _PROCESSES.Process(target=time.sleep, args=(0,))
    first.start()
    first.join()


def start(function: Callable[..., Any], *arguments: Any) -> Started:
    """Call a module-level function in a separate process."""
    ours, theirs = _PROCESSES.Pipe(duplex=False)
    process = _PROCESSES.Process(target=_child, args=(theirs, function, arguments))
    process.start()
    theirs.close()
    return Started(process, ours)


def _child(end: Connection, function: Callable[..., Any], arguments: Sequence[Any]) -> None:
    end.send(function(*arguments))
