"""Show lines of traffic on the terminal, and below them the state of a simulated arm."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from rich.constrain import Constrain
from rich.live import Live
from rich.table import Table as Grid
from rich.text import Text

from cobotwire.cli.shared.output import ECHO_COLUMNS, format_result
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
# A simulated arm replies at once or not at all.
REPLY_SECONDS = 0.05


class JointTable:
    """Queries the arm as a client does, over a connection that prints no traffic.

    Lines are collected, and appear above the table when it is drawn next. So the table is not
    drawn again for each line, which would delay the arm's replies.
    """

    def __init__(self, edition: Edition, arm: SimulatedArm, clock: RunningClock) -> None:
        transport = MemoryTransport(arm.connect(lambda event, reply: None), clock)
        self._arm = edition.CLIENT(transport, timeout=REPLY_SECONDS)
        self._clock, self._began = clock, clock()
        self._remark = arm.table.robot.geometry_remark or None
        self._live = Live(auto_refresh=False)
        self._lines: list[str] = []
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
        self._print_lines()
        self._live.stop()

    def add_line(self, line: str) -> None:
        """Show a line above the table when it is drawn next."""
        self._lines.append(line)

    def update(self) -> None:
        """Show the collected lines, and draw the table with the current state."""
        self._print_lines()
        title = f"{self._clock() - self._began:.1f} s of simulated time"
        grid = Grid(title=title, caption=self._remark, show_header=False)
        for label, name in self._rows:
            grid.add_row(label, self._query(name))
        width = self._live.console.width - ECHO_COLUMNS
        self._live.update(Constrain(grid, width), refresh=True)

    def _print_lines(self) -> None:
        if self._lines:
            # As plain text, because received bytes may look like markup.
            self._live.console.print(Text("\n".join(self._lines)))
            self._lines.clear()

    def _query(self, name: str) -> str:
        try:
            return format_result(getattr(self._arm, name)())
        except CobotwireError:
            return "no reply"
