"""Compare the speed of the working tree with that of another revision: ``compare.py REVISION``.

Each round runs `speed.py` of this folder on both trees, one directly after the other; the one that
starts alternates. The ratio of a round is the time of the revision divided by that of the working
tree: above 1, the working tree is faster. The table shows the median of the ratios and the range of
their middle half. A row is called faster or slower only if that whole range is more than 2 % away
from 1. The row "memcpy in two threads" does not depend on the trees: it shows how much the machine
disturbs the figures.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from speed_table import human

ROOT = Path(__file__).parents[1]
MODULE = Path("python", "cobotwire", "_native.abi3.so")
# Two processes of the same program differ by up to this share, because of their memory addresses.
SAME = 0.02


class Compared(NamedTuple):
    """The seconds of a row in each round, on both trees."""

    row: str
    ours: Sequence[float]
    theirs: Sequence[float]

    @property
    def quartiles(self) -> Sequence[float]:
        """The quartiles of how many times faster the working tree was, round by round."""
        ratios = [theirs / ours for ours, theirs in zip(self.ours, self.theirs)]
        return statistics.quantiles(ratios, n=4, method="inclusive")

    @property
    def verdict(self) -> str:
        """Whether the working tree is faster or slower in the middle half of the rounds."""
        low, _, high = self.quartiles
        return "faster" if low > 1 + SAME else "slower" if high < 1 - SAME else "the same"

    def __str__(self) -> str:
        low, middle, high = self.quartiles
        ours, theirs = (human(statistics.median(spent)) for spent in (self.ours, self.theirs))
        spread = f"{low:.3f} to {high:.3f}"
        return f"{self.row:44}{ours:>9}{theirs:>9}{middle:8.3f} x   {spread}   {self.verdict}"


def main() -> None:
    """Build the revision, measure both trees and print; unknown options are those of speed.py."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("revision", help="anything that git calls a commit: HEAD~3, main, a hash")
    parser.add_argument("--rounds", type=int, default=15)
    options, more = parser.parse_known_args()
    try:
        found = compare((ROOT, built(options.revision)), options.rounds, more)
    except subprocess.CalledProcessError as error:
        sys.exit(f"bench-compare: {error}; its messages are above")
    print(f"working tree, {options.revision}, ratio, its middle half", *found, sep="\n")


def compare(trees: tuple[Path, Path], rounds: int, more: Sequence[str]) -> list[Compared]:
    """Return the seconds of each row on both trees, which read the same streams."""
    ours: list[dict[str, float]] = []
    theirs: list[dict[str, float]] = []
    with TemporaryDirectory() as folder:
        for turn in range(rounds):
            order = list(zip((ours, theirs), trees))
            for times, tree in order if turn % 2 else order[::-1]:
                times.append(_seconds(tree, Path(folder), more))
    return [
        Compared(row, [times[row] for times in ours], [times[row] for times in theirs])
        for row in ours[0]
    ]


def _seconds(tree: Path, folder: Path, more: Sequence[str]) -> dict[str, float]:
    """Run one round of the rows on a tree."""
    bench, report = Path(__file__).parent, folder / "report.json"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (tree / "python", bench)))}
    command = [sys.executable, str(bench / "speed.py"), "--rounds", "1", "--json", str(report)]
    command += ["--streams", str(folder), *more]
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
    rows = enumerate(json.loads(report.read_text()))
    # Several groups of the table have a row of the same name, so the number makes it unique.
    return {f"{number:2} {row['row']}": row["seconds"] for number, row in rows}


def built(revision: str) -> Path:
    """Return the folder of a revision, below target/compare; extract and build what is missing."""
    command = ["git", "rev-parse", "--verify", "--short=12", f"{revision}^{{commit}}"]
    found = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    tree = ROOT / "target" / "compare" / found.stdout.strip()
    if not tree.exists():
        command = ["git", "worktree", "add", "--detach", str(tree), revision]
        subprocess.run(command, cwd=ROOT, check=True)
    if not (tree / MODULE).exists():
        target = ROOT / "target" / "compare" / "build"
        environment = {**os.environ, "CARGO_TARGET_DIR": str(target), "PYO3_PYTHON": sys.executable}
        command = ["cargo", "build", "--release", "--quiet", "--package", "cobotwire-native"]
        command += ["--features", "pyo3/extension-module"]
        subprocess.run(command, cwd=tree, env=environment, check=True)
        libraries = [target / "release" / f"lib_native.{suffix}" for suffix in ("so", "dylib")]
        shutil.copyfile(next(each for each in libraries if each.exists()), tree / MODULE)
    return tree


if __name__ == "__main__":
    main()
