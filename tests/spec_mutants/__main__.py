"""``python -m spec_mutants`` changes each fact of the spec and reports which changes survive."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

from spec_mutants.campaign import Result, run_all, tasks
from spec_mutants.survivors import accepted

LEAST = 0.98


def main() -> int:
    """Run the mutants, print the table and the survivors, and return the exit code."""
    parser = argparse.ArgumentParser(prog="spec_mutants", description=__doc__)
    parser.add_argument("--every", type=int, default=1, metavar="N", help="run every N-th mutant")
    parser.add_argument("--only", default="", metavar="TEXT", help="run mutants with this in them")
    parser.add_argument("--processes", type=int, default=2, metavar="N")
    given = parser.parse_args()
    chosen = [task for task in tasks() if given.only in f"{task.kind} {task.title}"]
    chosen = chosen[:: given.every]
    began = time.monotonic()
    results = run_all(chosen, given.processes, lambda done: _progress(done, len(chosen)))
    return _report(results, time.monotonic() - began)


def _progress(done: int, total: int) -> None:
    if sys.stderr.isatty() or done % 200 == 0 or done == total:
        end = "\r" if sys.stderr.isatty() and done < total else "\n"
        print(f"{done} of {total} mutants", end=end, file=sys.stderr, flush=True)


def _report(results: list[Result], seconds: float) -> int:
    """Print kills per edition, and the survivors; return 1 if there are too many."""
    differing = [(task, verdict) for task, verdict in results if not verdict.equal]
    total, killed, listed = Counter[str](), Counter[str](), Counter[str]()
    for task, verdict in differing:
        total[task.edition] += 1
        killed[task.edition] += bool(verdict.killer)
        if not verdict.killer:
            reason = accepted(task.edition, task.kind, task.title)
            listed[task.edition] += bool(reason)
            print(f"survives  {task.kind}  {task.title}: {reason or 'WITHOUT A REASON'}")
    shares = {name: killed[name] / max(1, total[name] - listed[name]) for name in total}
    print(f"{'edition':17} {'mutants':>7} {'killed':>7} {'unconfirmed':>12} {'of the rest':>12}")
    for name, share in shares.items():
        print(f"{name:17} {total[name]:7} {killed[name]:7} {listed[name]:12} {share:12.1%}")
    print(
        f"{killed.total()} of {total.total()} mutants killed, {listed.total()} unconfirmed; "
        f"{len(results) - len(differing)} more leave the edition as it is; {seconds:.0f} s"
    )
    return int(min(shares.values(), default=1) < LEAST)


if __name__ == "__main__":
    assert Path("spec").is_dir(), "run this in the project"
    sys.exit(main())
