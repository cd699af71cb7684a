"""Run the commands and Python programs of README and website with this environment's programs.

    python run_pages.py [PAGE ...]    # such as README.md docs/guide/drive.md; all without arguments

`make wheels-check` runs it in fresh environments. `console` blocks and text after Python blocks
show the output; `newcomer.website.plans` says what other commands print. A command with no plan is
a failure, so that no new one goes unchecked. What cannot be run is printed with the reason.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from newcomer.website.planned import Plan, unplanned
from newcomer.website.plans.every import PLANS
from newcomer.website.running import Result, run_page

ROOT = Path(__file__).parents[2]


def pages() -> list[str]:
    """Return the pages that people write; generated ones have examples of another form."""
    found = [page.relative_to(ROOT).as_posix() for page in (ROOT / "docs").rglob("*.md")]
    generated = ("docs/reference/", "docs/robots/", "docs/_build/")
    written = [page for page in found if not page.startswith(generated)]
    return ["README.md", *sorted(written)]


def main() -> int:
    """Run the pages; return 1 if a command prints something other than its page shows."""
    # A shell that starts this in the background disables Ctrl-C; some commands end only with it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.environ["PATH"] = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    os.environ["COLUMNS"] = "100"
    os.environ.pop("PYTHONPATH", None)
    counts: Counter[str] = Counter()
    for page in sys.argv[1:] or pages():
        plan = PLANS.get(page, Plan())
        start = time.monotonic()
        wrong = unplanned((ROOT / page).read_text(encoding="utf-8"), plan)
        done = [_print(Result(page, problem)) for problem in wrong]
        with tempfile.TemporaryDirectory() as folder:
            for part in ("spec", "docs/answers"):
                shutil.copytree(ROOT / part, Path(folder) / part)
            done += [_print(each) for each in run_page(ROOT / page, plan, Path(folder))]
        counts.update(done)
        if done:
            print(f"      {page}: {time.monotonic() - start:.0f} s", flush=True)
    print(f"{counts['ok']} as shown, {counts['skip']} not run, {counts['FAIL']} failed")
    return 1 if counts["FAIL"] else 0


def _print(done: Result) -> str:
    kind = "FAIL" if done.problem else "skip" if done.reason else "ok"
    why = f": {done.problem or done.reason}" if kind != "ok" else ""
    print(f"{kind:4}  {done.what}{why}", flush=True)
    return kind


if __name__ == "__main__":
    sys.exit(main())
