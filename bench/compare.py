"""Compare the speed of the working tree with that of another revision, in one run.

Each round of a row runs both trees, one directly after the other; the one that starts alternates.
The ratio of a round is the time of the revision divided by that of the working tree: above 1, the
working tree is faster. The table shows the median of the ratios and the range of their middle half.
A row is called faster or slower only if that whole range is more than 2 % away from 1. The row
"memcpy" does not depend on the trees: it shows how much the machine disturbs the figures.
"""

from __future__ import annotations

import argparse
import os
import re
import statistics
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table as RichTable

import compare_builds
from compare_worker import CLIENT_ROWS, ROWS
from speed_rows import Streams
from speed_table import human

ALL = (*ROWS, *CLIENT_ROWS)
# Two processes that run the same program differ by as much, because their memory lies elsewhere.
SAME = 0.02


@dataclass(frozen=True)
class Compared:
    """The seconds of a row in each round; empty if a tree cannot run it."""

    row: str
    ours: Sequence[float]
    theirs: Sequence[float]

    @property
    def ratios(self) -> list[float]:
        """How many times faster the working tree was, round by round."""
        return [theirs / ours for ours, theirs in zip(self.ours, self.theirs)]

    @property
    def quartiles(self) -> tuple[float, float, float]:
        """The lower quartile of the ratios, their median, and the upper quartile."""
        low, middle, high = statistics.quantiles(self.ratios, n=4, method="inclusive")
        return low, middle, high

    @property
    def verdict(self) -> str:
        """Whether the working tree is faster or slower in the middle half of the rounds."""
        low, _, high = self.quartiles
        return "faster" if low > 1 + SAME else "slower" if high < 1 - SAME else "the same"


class Worker:
    """A process that runs rows on one tree."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.package = self._line()

    def run(self, row: str) -> float | None:
        """Run a row once; return its seconds, or None if the tree cannot run it."""
        assert self.process.stdin is not None
        print(row, file=self.process.stdin, flush=True)
        answer = self._line()
        return None if answer == "-" else float(answer)

    def end(self) -> None:
        """Let the process close its ports and end."""
        self.process.communicate(timeout=60)

    def _line(self) -> str:
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit("a process of the comparison ended; its messages are above")
        return line.strip()


def main() -> None:
    """Build, measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("revision", help="anything that git calls a commit: HEAD~3, main, a hash")
    parser.add_argument("--rows", default="", help="only rows that match this expression")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--megabytes", type=float, default=256, help="of each large stream")
    parser.add_argument("--frames", type=int, default=300_000, help="that become Python objects")
    options = parser.parse_args()
    try:
        trees = compare_builds.working_tree(), compare_builds.built(options.revision)
    except compare_builds.NoBuildError as error:
        sys.exit(f"bench-compare: {error}")
    rows = [row for row in ALL if re.search(options.rows, row)]
    with TemporaryDirectory() as folder:
        Streams.write(Path(folder), options.megabytes, options.frames)
        found = compare(trees, Path(folder), rows, options.rounds)
        show(f"working tree against {options.revision}", found, Console(width=100))


def compare(
    trees: tuple[Path, Path], folder: Path, rows: Sequence[str], rounds: int
) -> Iterator[Compared]:
    """Yield each row of the two trees; the streams are in ``folder``."""
    with worker(trees[0], folder) as ours, worker(trees[1], folder) as theirs:
        for row in rows:
            taken: dict[Worker, list[float]] = {ours: [], theirs: []}
            for turn in range(rounds):
                order = (ours, theirs) if turn % 2 else (theirs, ours)
                seconds = {each: each.run(row) for each in order}
                if None in seconds.values():
                    break
                for each, spent in seconds.items():
                    taken[each].append(spent or 0.0)
            yield Compared(row, taken[ours], taken[theirs])


@contextmanager
def worker(tree: Path, folder: Path) -> Iterator[Worker]:
    """Start a process that runs rows on ``tree``, and end it."""
    package = tree / "python"
    bench = Path(__file__).parent
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (package, bench)))}
    command = [sys.executable, str(bench / "compare_worker.py"), str(folder)]
    with subprocess.Popen(
        command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            found = Worker(process)
            assert Path(found.package) == package / "cobotwire", f"imported from {found.package}"
            yield found
            found.end()
        finally:
            process.kill()


def show(title: str, found: Iterator[Compared], console: Console) -> None:
    """Print the rows as a table."""
    table = RichTable(title=title, title_justify="left")
    names = {"row": "left", "ours": "right", "theirs": "right", "ratio": "right"}
    for name, justify in {**names, "middle half": "left", "": "left"}.items():
        table.add_column(name, justify="left" if justify == "left" else "right")
    for each in found:
        if len(each.ours) < 2:
            table.add_row(each.row, "", "", "", "a tree cannot run it", "")
            continue
        low, middle, high = each.quartiles
        ours, theirs = (human(statistics.median(spent)) for spent in (each.ours, each.theirs))
        spread = f"{low:.3f} to {high:.3f}"
        table.add_row(each.row, ours, theirs, f"{middle:.3f} x", spread, each.verdict)
    console.print(table)


if __name__ == "__main__":
    main()
