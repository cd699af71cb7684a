"""Count how many broken subjects the testers find; print killed / total and every survivor.

PYTHONPATH=tests python -m mutation --sample 3           run three mutants of each kind
PYTHONPATH=tests python -m mutation mycobot device       run an edition, and all device suites
PYTHONPATH=tests python -m mutation --sample 3 --write   write the table of docs/conformance.md
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from mutation.listing import counted, lines, page, rewritten, table
from mutation.running import run
from mutation.suites import NAMES
from vectors import ROOT

DOCUMENT = ROOT / "docs" / "conformance.md"


def main() -> int:
    """Run the suites and print the figures; return 1 if a tester missed something."""
    given = _arguments()
    places = [
        place
        for place, name in enumerate(NAMES)
        if not given.suites or any(word in name.split(", ") for word in given.suites)
    ]
    began = time.monotonic()
    found = []
    for verdicts in run(places, given.processes, given.sample, given.seed):
        found.append(verdicts)
        print("\n".join(lines(verdicts)), flush=True)
    seconds = time.monotonic() - began
    print(f"{seconds:.0f} s")
    if given.page:
        given.page.write_text(page(found, seconds))
    if given.write:
        text = DOCUMENT.read_text("utf-8")
        DOCUMENT.write_text(rewritten(text, table(map(counted, found))), "utf-8")
    return 0 if all(verdicts.sound for verdicts in found) else 1


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "suites", nargs="*", help="editions, or device, client with a script, codec; default: all"
    )
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--sample", type=int, help="at most this many mutants of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--write", action="store_true", help="write the table into the document")
    parser.add_argument("--page", type=Path, help="write the list of survivors to this file")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
