"""Print the table of ``make robots``, and compare it with the one in docs/robots.md."""

from __future__ import annotations

import sys
from pathlib import Path

from robots.classes import ROBOTS
from robots.comparison import compare
from robots.table import HEADING, row_of

PAGE = Path(__file__).parents[3] / "docs" / "robots.md"


def main(arguments: list[str]) -> int:
    """Print the table, then the reasons; with ``--write``, put the table into the page.

    Return 1 if a difference has no ruling, or the page has another table.
    """
    found = {peer: compare(robot) for peer, robot in ROBOTS.items()}
    table = "\n".join([HEADING, *(row_of(ROBOTS[peer], each) for peer, each in found.items())])
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


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
