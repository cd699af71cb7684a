"""``python -m spec_mutants`` changes each fact of the spec and reports which changes survive."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

from spec_mutants.campaign import Result, Task, run_all, tasks
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
    judged = [(task, verdict) for task, verdict in results if not verdict.equal]
    killed, total = Counter[str](), Counter[str]()
    for task, verdict in judged:
        total[task.kind] += 1
        killed[task.kind] += bool(verdict.killer)
    width = max((len(kind) for kind in total), default=0)
    for kind in sorted(total):
        print(f"{kind:{width}}  {killed[kind]:4} / {total[kind]}")
    survivors = [task for task, verdict in judged if not verdict.killer]
    unexplained = [task for task in survivors if not _explained(task)]
    for task in unexplained:
        print(f"SURVIVES WITHOUT A REASON  {task.kind}  {task.title}")
    share = sum(killed.values()) / max(1, len(judged))
    print(
        f"{sum(killed.values())} of {len(judged)} mutants killed ({share:.1%}); "
        f"{len(results) - len(judged)} more leave the edition as it is; {seconds:.0f} s"
    )
    return 1 if unexplained or share < LEAST else 0


def _explained(task: Task) -> bool:
    reason = accepted(task.kind, task.title)
    if reason:
        print(f"survives  {task.kind}  {task.title}: {reason}")
    return bool(reason)


if __name__ == "__main__":
    assert Path("spec").is_dir(), "run this in the project"
    sys.exit(main())
