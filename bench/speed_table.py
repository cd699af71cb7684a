"""What the speed bench prints: ratios of what was timed side by side, beside what is asked."""

from __future__ import annotations

import json
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rich.console import Console
from rich.table import Table as RichTable

Work = Callable[[], object]


@dataclass
class Timed:
    """One thing that is timed: seconds a run, one entry a round."""

    work: Work
    times_a_round: int = 1
    scale: float = 1.0
    seconds: list[float] = field(default_factory=list)

    def run(self) -> None:
        """One round."""
        work = self.work
        started = time.perf_counter()
        for _ in range(self.times_a_round):
            work()
        spent = time.perf_counter() - started
        self.seconds.append(spent / self.times_a_round * self.scale)


@dataclass(frozen=True)
class Asked:
    """A ratio asked for: ``ours`` takes at most ``limit`` x ``peer``; or is so much faster."""

    row: str
    ours: str
    peer: str
    limit: float
    faster: bool = False


def Told(row: str, ours: str, peer: str) -> Asked:
    """A ratio that nobody asks for, and that one should know."""
    return Asked(row, ours, peer, 0, faster=True)


@dataclass(frozen=True)
class Ratio:
    """A ratio as it was measured: the median over the rounds, each beside its peer's round."""

    asked: Asked
    measured: float
    ours_seconds: float

    @property
    def met(self) -> bool:
        """Whether it is what was asked for."""
        if self.asked.faster:
            return self.measured >= self.asked.limit
        return self.measured <= self.asked.limit


def measure(timed: dict[str, Timed], rounds: int) -> None:
    """Run everything in turn, again and again, so that a slow moment meets all of it."""
    for each in timed.values():
        each.work()  # not counted: memory and caches are as they stay
    for _ in range(rounds):
        for each in timed.values():
            each.run()


def ratios(timed: dict[str, Timed], asked: Sequence[Asked]) -> list[Ratio]:
    """The ratios that are asked for."""
    found = []
    for each in asked:
        ours, peer = timed[each.ours].seconds, timed[each.peer].seconds
        pairs = [(a, b) for a, b in zip(ours, peer)]
        measured = statistics.median(b / a if each.faster else a / b for a, b in pairs)
        found.append(Ratio(each, measured, statistics.median(ours)))
    return found


def show(title: str, found: Sequence[Ratio], console: Console) -> None:
    """Print the ratios as a table."""
    table = RichTable(title=title, title_justify="left")
    for name in ("work", "against", "measured", "asked", "", "ours"):
        table.add_column(name, justify="right" if name in ("measured", "asked", "ours") else "left")
    for ratio in found:
        asked = ratio.asked
        bound = f"{asked.limit:g} x faster" if asked.faster else f"{asked.limit:g} x"
        verdict = "[green]met[/]" if ratio.met else "[red]NOT MET[/]"
        if not asked.limit:
            bound, verdict = "", ""
        measured = f"{ratio.measured:,.2f} x"
        table.add_row(asked.row, asked.peer, measured, bound, verdict, human(ratio.ours_seconds))
    console.print(table)


def human(seconds: float) -> str:
    """A time in the unit that fits it."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def write_json(path: Path, found: Sequence[Ratio]) -> None:
    """All ratios, for machines."""
    rows = [
        {
            "row": ratio.asked.row,
            "against": ratio.asked.peer,
            "measured": ratio.measured,
            "asked": ratio.asked.limit,
            "faster": ratio.asked.faster,
            "met": ratio.met,
            "seconds": ratio.ours_seconds,
        }
        for ratio in found
    ]
    path.write_text(json.dumps(rows, indent=1) + "\n")
