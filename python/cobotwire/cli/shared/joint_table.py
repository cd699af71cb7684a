"""Show the state of a simulated arm as a table on the terminal."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from rich.constrain import Constrain
from rich.live import Live
from rich.table import Table as Grid

from cobotwire.cli.shared.output import format_result
from cobotwire.editions import Edition
from cobotwire.protocol.errors import CobotwireError
from cobotwire.protocol.table import Role
from cobotwire.simulator import MemoryTransport, RunningClock, SimulatedArm

SHOWN: tuple[tuple[Role, str], ...] = (
    ("joints", "joints, degrees"),
    ("coordinates", "end, mm and degrees"),
    ("powered", "powered"),
    ("moving", "moving"),
)
# The arm replies at once, or never.
REPLY_SECONDS = 0.05
# The terminal echoes ^C after the last row of the table; there it must not begin another row.
ECHO_COLUMNS = 3


class JointTable:
    """Queries the arm as a client does, over a connection whose traffic is not printed."""

    def __init__(self, edition: Edition, arm: SimulatedArm, clock: RunningClock) -> None:
        transport = MemoryTransport(arm.connect(lambda event, answer: None), clock)
        self._arm = edition.CLIENT(transport, timeout=REPLY_SECONDS)
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

    def update(self) -> None:
        """Draw the table with the current state."""
        title = f"{self._clock() - self._began:.1f} s of simulated time"
        grid = Grid(title=title, show_header=False)
        for label, name in self._rows:
            grid.add_row(label, self._query(name))
        width = self._live.console.width - ECHO_COLUMNS
        self._live.update(Constrain(grid, width), refresh=True)

    def _query(self, name: str) -> str:
        try:
            return format_result(getattr(self._arm, name)())
        except CobotwireError:
            return "no reply"
