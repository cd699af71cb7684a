"""Run the property tests of the codecs for some time: ``python tests/deep.py SECONDS``.

Hypothesis takes a number of examples, not a time. So each round measures how long its examples
take, and the next round takes as many as fit into the remaining time.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parent.parent
FIRST = 25
# A round smaller than the first finds nothing new, so none is started. Only a share of the
# remaining time is planned, because a round planned to the last second would end late.
SHARE = 0.8


def main(seconds: float) -> int:
    """Run rounds until the time is over or a property fails. Return 1 if one failed."""
    started = time.monotonic()
    examples, rounds, passed = FIRST, 0, 0
    while True:
        round_started = time.monotonic()
        status, count = _round(examples)
        rounds, passed = rounds + 1, passed + count
        took, left = time.monotonic() - round_started, seconds - (time.monotonic() - started)
        more = int(SHARE * left * examples / took)
        if status or more < FIRST:
            break
        examples = more
    verdict = "FAILED" if status else "ok"
    print(
        f"properties of both codecs: {time.monotonic() - started:.0f} s, {rounds} rounds, "
        f"{passed:,} examples   {verdict}"
    )
    return 1 if status else 0


def _round(examples: int) -> tuple[int, int]:
    """Run pytest once. Return its status and the number of examples that passed."""
    command = [sys.executable, "-m", "pytest", "-q", "-m", "hypothesis", "tests/codec"]
    done = subprocess.run(  # trusted: our own tests
        [*command, "--hypothesis-show-statistics"],
        cwd=ROOT,
        env={
            **os.environ,
            "HYPOTHESIS_PROFILE": "deep",
            "HYPOTHESIS_EXAMPLES": str(examples),
        },
        capture_output=True,
        text=True,
    )
    if done.returncode:
        print(done.stdout, done.stderr)
    counts = re.findall(r"^ +- (\d+) passing", done.stdout, re.MULTILINE)
    return done.returncode, sum(map(int, counts))


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1])))
