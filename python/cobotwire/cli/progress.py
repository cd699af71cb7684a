"""How far a test is, on a terminal; nothing where nobody looks."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import Progress

from cobotwire.conformance.device import Step


class Shown:
    """A bar on standard error, while the ``with`` block runs and if that is a terminal."""

    def __init__(self) -> None:
        self._bar = Progress(console=Console(stderr=True), transient=True)
        self._bar.disable = not self._bar.console.is_terminal
        self._task = self._bar.add_task("")

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._bar.stop()

    def step(self, step: Step, index: int, count: int) -> None:
        """Show that a step begins."""
        self._bar.update(self._task, description=step.name, completed=index, total=count)
