"""Print the table of ``make robots``, and compare it with the one in docs/robots.md."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from robots.classes import ROBOTS
from robots.comparison import Compared, compare
from robots.robot import Robot

HEADING = "| class | edition | methods | equal | ruled | open |\n|---|---|--:|--:|--:|--:|"

PAGE = Path(__file__).parents[3] / "docs" / "robots.md"


def main(arguments: list[str]) -> int:
    """Print the table, then the reasons; with ``--write``, put the table into the page.

    Return 1 if a difference has no ruling, or the page has another table.
    """
    found = {peer: compare(robot) for peer, robot in ROBOTS.items()}
    table = "\n".join([HEADING, *(_row(ROBOTS[peer], each) for peer, each in found.items())])
    print(f"{table}\n")
    left = 0
    for peer, methods in found.items():
        for each in methods:
            for why in each.reasons:
                print(f"ruled: {peer}.{each.method}: {why}")
            for text in each.open:
                print(f"OPEN: {peer}.{each.method}: {text}")
                left += 1
    page = PAGE.read_text()
    before, after = page[: page.index(HEADING)], page[page.index(HEADING) :].partition("\n\n")[2]
    if "--write" in arguments:
        PAGE.write_text(f"{before}{table}\n\n{after}")
    elif f"{before}{table}\n\n{after}" != page:
        print(f"STALE: {PAGE} has another table; write it with: make robots ROBOTS=--write")
        left += 1
    return 1 if left else 0


def _row(robot: Robot, found: Sequence[Compared]) -> str:
    """Return the row of a class in the table; each method counts once."""
    opened = sum(1 for each in found if each.open)
    ruled = sum(1 for each in found if each.ruled and not each.open)
    counts = (len(found), len(found) - ruled - opened, ruled, opened)
    return f"| {robot.peer} | `{robot.edition}` | " + " | ".join(map(str, counts)) + " |"


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
