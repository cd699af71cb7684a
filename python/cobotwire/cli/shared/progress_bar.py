"""Show how much of the input was read, or how many steps were run, on a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn, TimeRemainingColumn


@contextmanager
def progress_bar(
    work: str, size: int | None, *, hidden: bool = False
) -> Iterator[Callable[[int], None]]:
    """Yield a function to call with the size of each read; it moves a bar on a terminal.

    ``size`` is the number of bytes to read; None if it is not known.
    """
    console = Console(stderr=True)
    columns = TextColumn(work), BarColumn(), DownloadColumn(), TimeRemainingColumn()
    hidden = hidden or not console.is_terminal
    # The bar is removed at the end: the report takes its place.
    with Progress(*columns, console=console, disable=hidden, transient=True) as bar:
        task = bar.add_task(work, total=size)
        yield lambda read: bar.advance(task, read)


@contextmanager
def step_progress() -> Iterator[Callable[[str, int, int], None]]:
    """Yield a function that shows a step, how many are done, and how many there are."""
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("")
        yield lambda name, done, count: bar.update(
            task, description=name, completed=done, total=count
        )
