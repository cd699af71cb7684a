"""The table of a simulated arm's joints, live, below what goes over its line."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from rich.live import Live
from rich.table import Table as Grid

from cobotwire.cli.call import in_words
from cobotwire.editions import Edition
from cobotwire.errors import CobotwireError
from cobotwire.sim import MemoryLink, RunningClock, SimulatedArm
from cobotwire.table import Role

SHOWN: tuple[tuple[Role, str], ...] = (
    ("joints", "joints, degrees"),
    ("coordinates", "end, mm and degrees"),
    ("powered", "powered"),
    ("moving", "moving"),
)
# The arm answers at once; what it does not answer, it never will.
ANSWER_SECONDS = 0.05


class JointTable:
    """Asks the arm as a client does, by a line of its own that nobody is shown."""

    def __init__(self, edition: Edition, arm: SimulatedArm, clock: RunningClock) -> None:
        link = MemoryLink(arm.another_line(lambda event, answer: None), clock)
        self._arm = edition.CLIENT(link, timeout=ANSWER_SECONDS)
        self._clock, self._began = clock, clock()
        self._live = Live(auto_refresh=False)
        commands = edition.TABLE.commands
        self._rows = [
            (label, command.name)
            for role, label in SHOWN
            for command in commands
            if command.role == role
        ]

    def __enter__(self) -> Self:
        self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._live.stop()

    def look(self) -> None:
        """Draw it as it is now."""
        grid = Grid(title=f"{self._clock() - self._began:.1f} s of the arm", show_header=False)
        for label, name in self._rows:
            grid.add_row(label, self._ask(name))
        self._live.update(grid, refresh=True)

    def _ask(self, name: str) -> str:
        try:
            return in_words(getattr(self._arm, name)())
        except CobotwireError:
            return "no answer"
