"""Runs the property tests of the codecs for a while: ``python tests/deep.py SECONDS``.

Hypothesis is bounded by a number of examples, not by time. So a round measures how long a number
takes, and the next one takes as many as fit into what is left.
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
# A round that would be smaller than the first finds nothing new; one that is planned to the last
# second is late.
SHARE = 0.8


def main(seconds: float) -> int:
    """Rounds until the time is over, or something is found; 1 then."""
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
    """Pytest's status, and how many examples held."""
    command = [sys.executable, "-m", "pytest", "-q", "-m", "hypothesis", "tests/codec"]
    done = subprocess.run(  # our own program
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
