"""Define what runs the tasks of an archive, and run them on threads of this process."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Protocol, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")


class Engine(Protocol):
    """Runs tasks. A task may run again, and on any machine: its result must be the same."""

    def run(
        self, function: Callable[[Task], Result], tasks: Sequence[Task]
    ) -> Iterator[tuple[int, Result]]:
        """Yield the number of each task with its result, when it is complete, in any order.

        If a task fails, its error is raised, and tasks that have not started never start.
        """
        ...


class ThreadEngine:
    """Runs tasks on threads. Decoding and writing release the interpreter's lock."""

    def __init__(self, workers: int | None = None) -> None:
        """Run on ``workers`` threads, by default one for each processor."""
        self._workers = workers or os.cpu_count() or 1

    def run(
        self, function: Callable[[Task], Result], tasks: Sequence[Task]
    ) -> Iterator[tuple[int, Result]]:
        """Yield the results; at most one more task for each thread runs ahead of the consumer."""
        waiting = iter(enumerate(tasks))
        running: dict[Future[Result], int] = {}
        with ThreadPoolExecutor(self._workers) as pool:
            while True:
                for number, task in waiting:
                    running[pool.submit(function, task)] = number
                    if len(running) >= self._workers:
                        break
                if not running:
                    return
                for done in wait(running, return_when=FIRST_COMPLETED).done:
                    yield running.pop(done), done.result()
