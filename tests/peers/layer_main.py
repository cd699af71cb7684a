"""Compare all calls of our classes, and what they are rewritten to: ``make layer``."""

from __future__ import annotations

import sys
from contextlib import redirect_stdout
from io import StringIO

from cobotwire.pymycobot.migrate.calls import library
from layer_comparison import compare
from layer_replies import compare_replies
from layer_robots import CLOSED_LOOP, LAYER_ROBOTS
from migrated_calls import compare_migrated


def main() -> int:
    """Print how many calls and replies of each class are equal; return 1 if one needs a ruling."""
    left = 0
    for name, robot in {**LAYER_ROBOTS, **CLOSED_LOOP}.items():
        # The maker's classes print the errors of a robot.
        with redirect_stdout(StringIO()):
            calls = compare(robot)
            equal, ruled, wrong = compare_replies(robot) if name in CLOSED_LOOP else (0, set(), [])
        found = f"{calls.equal} calls equal, {calls.ruled} ruled"
        replies = f"; {equal} replies equal, {len(ruled)} methods ruled" if equal else ""
        print(f"{name}: {found}{replies}", flush=True)
        for text in (*calls.open, *wrong):
            print(f"OPEN: {text}")
            left += 1
    for name in sorted(library()):
        equal, listed, wrong = compare_migrated(name)
        print(f"{name}: {equal} rewritten calls equal, {listed} to decide", flush=True)
        for text in wrong:
            print(f"OPEN: {text}")
            left += 1
    return 1 if left else 0


if __name__ == "__main__":
    sys.exit(main())
