"""Count how many broken subjects the testers find; print killed / total and every survivor.

PYTHONPATH=tests python -m mutation --sample 3        run three mutants of each kind
PYTHONPATH=tests python -m mutation mycobot device    run an edition, and all device suites
"""

from __future__ import annotations

import argparse
import sys
import time

from mutation.listing import lines, table
from mutation.running import SUITES, TESTERS, run


def main() -> int:
    """Run the suites and print the figures; return 1 if a tester missed something."""
    given = _arguments()
    suites = [
        suite
        for suite in SUITES
        if not given.suites or suite.edition in given.suites or suite.tester in given.suites
    ]
    began = time.monotonic()
    found = []
    for verdicts in run(suites, given.processes, given.sample, given.seed):
        found.append(verdicts)
        print("\n".join(lines(verdicts)), flush=True)
    print(table(found))
    print(f"{time.monotonic() - began:.0f} s")
    return 0 if all(verdicts.sound for verdicts in found) else 1


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    names = f"editions, or {', '.join(TESTERS)}; default: all"
    parser.add_argument("suites", nargs="*", help=names)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--sample", type=int, help="at most this many mutants of each kind")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
