"""Compute the ratios of the speed bench, and print them with their targets."""

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
    """A piece of work to time, and the seconds per run in each round."""

    work: Work
    times_a_round: int = 1
    scale: float = 1.0
    seconds: list[float] = field(default_factory=list)

    def run(self) -> None:
        """Run one round."""
        work = self.work
        started = time.perf_counter()
        for _ in range(self.times_a_round):
            work()
        spent = time.perf_counter() - started
        self.seconds.append(spent / self.times_a_round * self.scale)


@dataclass(frozen=True)
class Target:
    """A target: ``ours`` takes at most ``limit`` x ``peer``, or is ``limit`` x faster than it."""

    row: str
    ours: str
    peer: str
    limit: float
    faster: bool = False


def untargeted(row: str, ours: str, peer: str, *, faster: bool = True) -> Target:
    """Return a ratio that is shown without a target."""
    return Target(row, ours, peer, 0, faster)


@dataclass(frozen=True)
class Ratio:
    """A measured ratio: the median over the rounds, each against its peer in the same round."""

    target: Target
    measured: float
    ours_seconds: float

    @property
    def met(self) -> bool:
        """Whether the ratio meets its target, if it has one."""
        if self.target.faster or not self.target.limit:
            return self.measured >= self.target.limit
        return self.measured <= self.target.limit


def measure(timed: dict[str, Timed], rounds: int) -> None:
    """Run everything in turn, round by round, so that a slow period affects all work equally."""
    for each in timed.values():
        each.work()  # not counted: it fills memory and caches
    for _ in range(rounds):
        for each in timed.values():
            each.run()


def ratios(timed: dict[str, Timed], targets: Sequence[Target]) -> list[Ratio]:
    """Return the measured ratio of each target."""
    found = []
    for each in targets:
        ours, peer = timed[each.ours].seconds, timed[each.peer].seconds
        pairs = [(a, b) for a, b in zip(ours, peer)]
        measured = statistics.median(b / a if each.faster else a / b for a, b in pairs)
        found.append(Ratio(each, measured, statistics.median(ours)))
    return found


def show(title: str, found: Sequence[Ratio], console: Console) -> None:
    """Print the ratios as a table."""
    table = RichTable(title=title, title_justify="left")
    for name in ("work", "against", "measured", "target", "", "ours"):
        table.add_column(
            name, justify="right" if name in ("measured", "target", "ours") else "left"
        )
    for ratio in found:
        target = ratio.target
        bound = f"{target.limit:g} x faster" if target.faster else f"{target.limit:g} x"
        verdict = "[green]met[/]" if ratio.met else "[red]NOT MET[/]"
        if not target.limit:
            bound, verdict = "", ""
        measured = f"{ratio.measured:,.2f} x"
        table.add_row(target.row, target.peer, measured, bound, verdict, human(ratio.ours_seconds))
    console.print(table)


def human(seconds: float) -> str:
    """Return a time in a fitting unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def write_json(path: Path, found: Sequence[Ratio]) -> None:
    """Write all ratios as JSON."""
    rows = [
        {
            "row": ratio.target.row,
            "against": ratio.target.peer,
            "measured": ratio.measured,
            "target": ratio.target.limit,
            "faster": ratio.target.faster,
            "met": ratio.met,
            "seconds": ratio.ours_seconds,
        }
        for ratio in found
    ]
    path.write_text(json.dumps(rows, indent=1) + "\n")
