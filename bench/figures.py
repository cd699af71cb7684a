"""Write the blocks of docs/figures.md, to which other pages link, and the table of the README.

    make figures-page                            all blocks; takes minutes
    make figures-page FIGURES="compared starts"  these

The counts come from the tables that `make table` and `make faults` write; each other block
names the machine, and has the output of a bench.
"""

from __future__ import annotations

import os
import platform
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGE, README = DOCS / "figures.md", ROOT / "README.md"
LINES, FAULTS = "bad-lines.md", "fault-scenarios.md"


class Counted(NamedTuple):
    """A row of the comparison, and the outcomes on a page whose counts it sums."""

    label: str
    page: str
    outcomes: tuple[str, ...]
    in_readme: bool = False


COUNTED = (
    Counted("86 runs on bad lines: every call right", LINES, ("right",), in_readme=True),
    Counted("… an error that says what happened", LINES, ("honest error",)),
    Counted(
        "… wrong: a wrong value, -1 or None, a crash, a hang, or a request sent too often",
        LINES,
        ("-1 or None", "crash", "wrong, silently", "sent too often", "hang"),
        in_readme=True,
    ),
    Counted("… of these: a wrong value", LINES, ("wrong, silently",)),
    Counted(
        "720 calls, 18 with each of 39 faults and 18 without: right",
        FAULTS,
        ("right",),
        in_readme=True,
    ),
    Counted("… an error that says what happened", FAULTS, ("honest error",)),
    Counted("… -1 or None instead of an error", FAULTS, ("-1 or None",)),
    Counted("… an exception that shows a mistake in the library", FAULTS, ("exception",)),
    Counted("… a wrong result without an error", FAULTS, ("wrong, silently",), in_readme=True),
    Counted(
        "requests to move or change the arm that arrived twice or more",
        FAULTS,
        ("(one-way requests that arrived twice or more)",),
        in_readme=True,
    ),
)
BENCHES = {
    "calls": ["client.py"],
    "frames": ["speed.py", "--rounds", "9", "--megabytes", "15", "--rows", "feed|encode"],
    "starts": ["imports.py"],
}
# The lines between the rows of a table start with these characters.
RULES = ("┏", "┡", "└")


def ours_and_theirs(page: str, *outcomes: str) -> tuple[int, int]:
    """Return the sums of outcomes on a page: of our client with its defaults, and of pymycobot."""
    text = (DOCS / page).read_text(encoding="utf-8")
    # The first row of each outcome is in the summary of the page.
    found = [re.search(rf"^\| {re.escape(each)} \|(.*)\|$", text, re.M) for each in outcomes]
    rows = [row[1].split("|") for row in found if row]
    if len(rows) != len(outcomes):
        raise LookupError(f"docs/{page} lacks a row of {outcomes}")
    return sum(int(row[0]) for row in rows), sum(int(row[-1]) for row in rows)


def compared(*, in_readme: bool = False) -> str:
    """Return the table of the comparison: all rows, or those of the README."""
    lines = ["| what was measured | cobotwire | pymycobot |", "|---|--:|--:|"]
    for row in COUNTED:
        ours, theirs = ours_and_theirs(row.page, *row.outcomes)
        if row.in_readme or not in_readme:
            lines.append(f"| {row.label} | {ours} | {theirs} |")
    return "\n".join(lines)


def printed(command: list[str]) -> str:
    """Return what a bench prints on this machine, as a code block."""
    done = subprocess.run(
        [sys.executable, str(ROOT / "bench" / command[0]), *command[1:]],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "COLUMNS": "110", "NO_COLOR": "1"},
    )
    rows = [line for line in done.stdout.strip().splitlines() if not line.startswith(RULES)]
    shown = "\n".join(re.sub("[│┃]", "", row).rstrip() for row in rows)
    return f"`python bench/{shlex.join(command)}` on {machine()}:\n\n```none\n{shown}\n```"


def machine() -> str:
    """Return what the figures depend on: processor, Python, and what else ran."""
    named = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(), re.M)
    processor = " ".join(named[1].split()) if named else platform.machine()
    python, load = platform.python_version(), os.getloadavg()[1]
    return f"{os.cpu_count()} cores of {processor}, Python {python}, load {load:.1f}"


def block(text: str, name: str, new: str | None = None) -> str:
    """Return a block of the page, or the page with a new one."""
    begin, end = f"<!-- begin: {name} -->\n\n", f"\n\n<!-- end: {name} -->"
    before, _, rest = text.partition(begin)
    old, _, after = rest.partition(end)
    return old if new is None else f"{before}{begin}{new}{end}{after}"


def main() -> None:
    """Write the named blocks, or all."""
    for name in sys.argv[1:] or ["compared", *BENCHES]:
        if name == "compared":
            _replace(README, name, compared(in_readme=True))
        _replace(PAGE, name, compared() if name == "compared" else printed(BENCHES[name]))
        print(f"docs/figures.md: {name}")


def _replace(page: Path, name: str, new: str) -> None:
    page.write_text(block(page.read_text(encoding="utf-8"), name, new), encoding="utf-8")


if __name__ == "__main__":
    main()
