"""Run the long searches one after another, and print one table (``make nightly``).

    python tools/nightly.py               run all searches
    python tools/nightly.py fuzz attack   run these

Each search is a target of the Makefile. Its output goes to target/nightly/<search>.log. The exit
code is 1 if a search failed. Ctrl-C ends the running search; the table shows those that had ended.
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
LOGS = ROOT / "target" / "nightly"
# The targets of the Makefile, the shortest first; with the variables that make a search longer.
SEARCHES = {
    "urdf": [],
    "archives": [],
    "every-edition": [],
    "attack": ["ATTACK_SECONDS=600"],
    "layer": [],
    "explore": [],
    "spec-mutants": [],
    "defects": [],
    "fuzz": ["FUZZ_SECONDS=120"],
    "conform": ["FULL=1"],
}


class Ended(NamedTuple):
    """A search that ended: exit code, minutes, minutes of processor time, last line of output."""

    search: str
    code: int
    minutes: float
    processor: float
    last_line: str

    def __str__(self) -> str:
        """Return its row of the table."""
        result = "passed" if self.code == 0 else f"FAILED ({self.code})"
        figures = f"{self.search:14}{result:12}{self.minutes:7.1f}{self.processor:11.1f}"
        return f"{figures}  {self.last_line}"


def main() -> int:
    """Run the searches that the command line names, or all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("searches", nargs="*", metavar="SEARCH", help=", ".join(SEARCHES))
    named = parser.parse_args().searches
    if unknown := set(named) - set(SEARCHES):
        parser.error(
            f"no such search: {', '.join(sorted(unknown))}; there are {', '.join(SEARCHES)}"
        )
    LOGS.mkdir(parents=True, exist_ok=True)
    ended: list[Ended] = []
    try:
        for search in named or SEARCHES:
            print(f"{search}: running; see {LOGS.relative_to(ROOT)}/{search}.log", flush=True)
            ended.append(_run(search))
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
    print(f"\n{'search':14}{'result':12}{'min':>7}{'processor':>11}  last line of its output")
    print(*ended, sep="\n")
    return int(len(ended) < len(named or SEARCHES) or any(one.code for one in ended))


def _run(search: str) -> Ended:
    """Run a target of the Makefile; on Ctrl-C, end it with all that it started."""
    log = LOGS / f"{search}.log"
    started, used = time.monotonic(), _processor_seconds()
    command = ["make", "--no-print-directory", search, *SEARCHES[search]]
    with log.open("w") as output:
        process = subprocess.Popen(  # noqa: S603  (the words are those above)
            command, cwd=ROOT, stdout=output, stderr=subprocess.STDOUT, start_new_session=True
        )
        try:
            code = process.wait()
        except KeyboardInterrupt:
            os.killpg(process.pid, signal.SIGINT)
            process.wait()
            raise
    lines = log.read_text(errors="replace").split("\n")
    last_line = next((line.strip() for line in reversed(lines) if line.strip()), "")
    minutes = (time.monotonic() - started) / 60
    return Ended(search, code, minutes, (_processor_seconds() - used) / 60, last_line[:80])


def _processor_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    sys.exit(main())
