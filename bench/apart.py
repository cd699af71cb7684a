"""A function in a process of its own, which is ended after a time limit: to hang is a result too.

The processes are forked from one that has imported what they need: importing is not what is timed.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from typing import Any, NamedTuple

_PROCESSES = multiprocessing.get_context("forkserver")


class Started(NamedTuple):
    """A process that will tell what its function gave."""

    process: multiprocessing.context.ForkServerProcess
    end: Connection

    def result(self, until: float) -> Any:
        """What the function gave; None if it does not come back by that ``time.monotonic()``."""
        given = None
        if self.end.poll(max(0.0, until - time.monotonic())):
            given = self.end.recv()
            self.process.join(1)
        self.process.kill()
        self.process.join()
        return given


def warm_up(modules: Sequence[str]) -> None:
    """Start the process that the others are forked from, with these modules imported."""
    _PROCESSES.set_forkserver_preload(list(modules))
    first = _PROCESSES.Process(target=time.sleep, args=(0,))
    first.start()
    first.join()


def start(function: Callable[..., Any], *arguments: Any) -> Started:
    """Call a function of a module in a process of its own."""
    ours, theirs = _PROCESSES.Pipe(duplex=False)
    process = _PROCESSES.Process(target=_child, args=(theirs, function, arguments))
    process.start()
    theirs.close()
    return Started(process, ours)


def _child(end: Connection, function: Callable[..., Any], arguments: Sequence[Any]) -> None:
    end.send(function(*arguments))
